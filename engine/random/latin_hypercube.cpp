#include "random/latin_hypercube.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/hash.h"

namespace gumshoe::random {

Permutation::Permutation(std::uint64_t size, std::uint64_t key)
    : size_(std::max<std::uint64_t>(size, 1)), key_(key),
      half_(std::max(1u, (static_cast<unsigned>(std::bit_width(size_ - 1)) + 1) / 2)) {}

std::uint64_t Permutation::operator()(std::uint64_t i) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_) - 1;
  do {
    std::uint64_t left = i >> half_, right = i & mask;
    for (std::uint64_t round = 0; round < rounds; ++round) {
      const std::uint64_t next = left ^ (mix64(round_key(round) ^ right) & mask);
      left = right;
      right = next;
    }
    i = left << half_ | right;
  } while (i >= size_);
  return i;
}

Permutation strata(const Stream& stream, std::uint64_t total) {
  return {total, derived_key(stream, 0x6c61'7469'6e00)}; // "latin"
}

double jitter_scale(std::uint64_t total) {
  return std::ldexp(1.0, std::max(1, 52 - static_cast<int>(std::bit_width(total))));
}

void latin_hypercube(const Stream& stream, std::uint64_t total, std::uint64_t first, std::size_t n, double* out) {
  const Permutation stratum = strata(stream, total);
  const double scale = jitter_scale(stratum.size());
  uniforms(stream, first, n, out);
  for (std::size_t i = 0; i < n; ++i) {
    const double jitter = (std::floor(out[i] * scale) + 0.5) / scale;
    out[i] =
        (static_cast<double>(stratum((first + i) % stratum.size())) + jitter) / static_cast<double>(stratum.size());
  }
}

} // namespace gumshoe::random
