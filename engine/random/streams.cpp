#include "random/streams.h"

#include "base/hash.h"
#include "random/philox.h"

namespace gumshoe::random {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  const philox4x32_ctr_t r = philox4x32_R(10, {{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {r.v[0], r.v[1], r.v[2], r.v[3]};
}

void uniforms(const Stream& stream, std::uint64_t first, std::size_t n, double* out) {
  fill_uniforms(stream, first, n, out);
}

double uniform(const Stream& stream, std::uint64_t sample) {
  double pair[2];
  fill_uniforms(stream, sample & ~std::uint64_t{1}, 2, pair);
  return pair[sample & 1];
}

std::uint64_t derived_key(const Stream& stream, std::uint64_t salt) {
  const std::uint64_t words =
      static_cast<std::uint64_t>(stream.reading) << 32 | static_cast<std::uint32_t>(stream.purpose) << 16 | stream.draw;
  return mix64(mix64(mix64(stream.key) ^ words) ^ salt);
}

} // namespace gumshoe::random
