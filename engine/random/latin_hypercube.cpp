#include "random/latin_hypercube.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/hash.h"

namespace gumshoe::random {

Permutation::Permutation(std::uint64_t size, std::uint64_t key)
    : size_(std::max<std::uint64_t>(size, 1)),
      columns_(static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(size_))))),
      rows_((size_ + columns_ - 1) / columns_) {
  for (std::uint64_t round = 0; round < rounds; ++round) keys_[round] = mix64(key + round * 0x9e3779b97f4a7c15u);
}

std::uint64_t Permutation::operator()(std::uint64_t i) const {
  do {
    std::uint64_t cell[2] = {i / columns_, i % columns_}; // row and column
    const std::uint64_t sides[2] = {rows_, columns_};
    for (std::uint64_t round = 0; round < rounds; ++round) {
      const std::uint64_t low = 0xffffffffu, key = keys_[round], moved = round % 2, side = sides[moved];
      const std::uint64_t product = ((cell[1 - moved] ^ key) & low) * first_multiplier;
      const std::uint64_t hash = (((product >> 32) ^ product ^ (key >> 32)) & low) * second_multiplier >> 32;
      cell[moved] += hash * side >> 32;
      if (cell[moved] >= side) cell[moved] -= side;
    }
    i = cell[0] * columns_ + cell[1];
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
