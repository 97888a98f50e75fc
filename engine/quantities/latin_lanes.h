#pragma once
/// Latin hypercubes in lanes: integers and exact or correctly rounded steps only, so that the bits are those of
/// random::latin_hypercube, with which the tests compare.
#include <algorithm>
#include <array>

#include "quantities/philox_lanes.h"
#include "random/latin_hypercube.h"

namespace gumshoe::quantities {

/// The lower 64 bits of a * b.
inline Words product(const Words& a, std::uint64_t b) {
  const Words low(b & 0xffffffffu), high(b >> 32);
  const Words crossed = product_of_low_words(a >> 32, low) + product_of_low_words(a, high);
  return product_of_low_words(a, low) + (crossed << 32);
}

/// mix64 of base/hash.h.
inline Words mix64_lanes(Words x) {
  x = x + Words(std::uint64_t{0x9e3779b97f4a7c15u});
  x = product(x ^ (x >> 30), 0xbf58476d1ce4e5b9u);
  x = product(x ^ (x >> 27), 0x94d049bb133111ebu);
  return x ^ (x >> 31);
}

/// Words that go through the network side by side, because its steps wait for each other.
constexpr std::size_t abreast = 4;
constexpr std::size_t feistel_step = abreast * Lanes::size;

/// One pass of a permutation's Feistel network over feistel_step values, in place; what comes out may lie beyond its
/// size.
inline void feistel_lanes(const random::Permutation& p, std::uint64_t* values) {
  const auto half = static_cast<int>(p.half_bits());
  const Words mask((std::uint64_t{1} << half) - 1);
  Words left[abreast], right[abreast];
  for (std::size_t k = 0; k < abreast; ++k) {
    const Words i = Words::load_unaligned(values + k * Lanes::size);
    left[k] = i >> half;
    right[k] = i & mask;
  }
  for (std::uint64_t round = 0; round < random::Permutation::rounds; ++round) {
    const Words key(p.round_key(round));
    for (std::size_t k = 0; k < abreast; ++k) {
      const Words next = left[k] ^ (mix64_lanes(right[k] ^ key) & mask);
      left[k] = right[k];
      right[k] = next;
    }
  }
  for (std::size_t k = 0; k < abreast; ++k) ((left[k] << half) | right[k]).store_unaligned(values + k * Lanes::size);
}

/// stratum[i] = p(stratum[i]) for i < n, at most permuted_strip; the rest of the strip is overwritten. What a pass
/// leaves beyond the permutation's size is gathered for the next one.
constexpr std::size_t permuted_strip = 512;
inline void permute_lanes(const random::Permutation& p, std::uint64_t* stratum, std::size_t n) {
  static_assert(permuted_strip % feistel_step == 0);
  for (std::size_t i = 0; i < n; i += feistel_step) feistel_lanes(p, stratum + i);
  std::array<std::uint32_t, permuted_strip> beyond;
  std::size_t left = 0;
  for (std::size_t i = 0; i < n; ++i) {
    beyond[left] = static_cast<std::uint32_t>(i);
    left += stratum[i] >= p.size() ? 1 : 0;
  }
  while (left > 0) {
    std::size_t still = 0;
    for (std::size_t k = 0; k < left; k += feistel_step) {
      alignas(64) std::uint64_t some[feistel_step] = {};
      const std::size_t count = std::min(feistel_step, left - k);
      for (std::size_t j = 0; j < count; ++j) some[j] = stratum[beyond[k + j]];
      feistel_lanes(p, some);
      for (std::size_t j = 0; j < count; ++j) {
        const std::uint32_t place = beyond[k + j];
        stratum[place] = some[j];
        beyond[still] = place;
        still += some[j] >= p.size() ? 1 : 0;
      }
    }
    left = still;
  }
}

/// random::latin_hypercube; n is a multiple of 8.
inline void fill_latin_in_lanes(const random::Stream& stream, const random::Permutation& p, std::uint64_t first,
                                std::size_t n, double* out) {
  fill_uniforms_in_lanes(stream, first, n, out);
  const double scale = random::jitter_scale(p.size());
  const Lanes total(static_cast<double>(p.size())), half(0.5);
  alignas(64) std::array<std::uint64_t, permuted_strip> stratum{};
  std::uint64_t place = first % p.size();
  for (std::size_t start = 0; start < n; start += permuted_strip) {
    const std::size_t count = std::min(permuted_strip, n - start);
    for (std::size_t i = 0; i < count; ++i) {
      stratum[i] = place;
      place = place + 1 < p.size() ? place + 1 : 0;
    }
    permute_lanes(p, stratum.data(), count);
    for (std::size_t i = 0; i < count; i += Lanes::size) {
      double* const at = out + start + i;
      const Lanes jitter = (xsimd::floor(Lanes::load_unaligned(at) * Lanes(scale)) + half) * Lanes(1 / scale);
      ((to_double<Lanes>(Words::load_unaligned(&stratum[i])) + jitter) / total).store_unaligned(at);
    }
  }
}

} // namespace gumshoe::quantities
