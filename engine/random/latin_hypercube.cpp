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
    // Six rounds: four already pass for pseudorandom, two are a margin for very small domains.
    for (std::uint64_t round = 0; round < 6; ++round) {
      const std::uint64_t next = left ^ (mix64((key_ + round * 0x9e3779b97f4a7c15u) ^ right) & mask);
      left = right;
      right = next;
    }
    i = left << half_ | right;
  } while (i >= size_);
  return i;
}

void latin_hypercube(const Stream& stream, std::uint64_t total, std::uint64_t first, std::size_t n, double* out) {
  total = std::max<std::uint64_t>(total, 1);
  const Permutation stratum(total, derived_key(stream, 0x6c61'7469'6e00)); // "latin"
  // The jitter keeps only as many bits as leave stratum + jitter exact, so that no sum rounds into
  // the next stratum.
  const int bits = std::max(1, 52 - static_cast<int>(std::bit_width(total)));
  const double scale = std::ldexp(1.0, bits);
  uniforms(stream, first, n, out);
  for (std::size_t i = 0; i < n; ++i) {
    const double jitter = (std::floor(out[i] * scale) + 0.5) / scale;
    out[i] = (static_cast<double>(stratum((first + i) % total)) + jitter) / static_cast<double>(total);
  }
}

} // namespace gumshoe::random
