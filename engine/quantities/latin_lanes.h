#pragma once
/// Latin hypercubes in lanes: integers and exact or correctly rounded steps only, so that the bits are those of
/// random::latin_hypercube, with which the tests compare.
#include <algorithm>
#include <array>

#include "quantities/philox_lanes.h"
#include "random/latin_hypercube.h"

namespace gumshoe::quantities {

/// x modulo `side`, for x below twice the side and a side below 2^62.
inline Words within(const Words& x, const Words& side) {
  const Words less = x - side;
  return less + (side & (Words(std::uint64_t{0}) - (less >> 63)));
}

/// Cells that go through the network side by side, because its steps wait for each other.
constexpr std::size_t abreast = 4;
constexpr std::size_t feistel_step = abreast * Lanes::size;

/// One pass of a permutation's Feistel network over feistel_step cells; `row` becomes the number of the cell, which may
/// lie beyond the permutation's size.
inline void feistel_lanes(const random::Permutation& p, std::uint64_t* row, const std::uint64_t* column) {
  using random::Permutation;
  const Words first(Permutation::first_multiplier), second(Permutation::second_multiplier);
  const Words sides[2] = {Words(p.rows()), Words(p.columns())};
  Words cell[2][abreast];
  for (std::size_t k = 0; k < abreast; ++k) {
    cell[0][k] = Words::load_unaligned(row + k * Lanes::size);
    cell[1][k] = Words::load_unaligned(column + k * Lanes::size);
  }
  for (std::uint64_t round = 0; round < Permutation::rounds; ++round) {
    const std::uint64_t moved = round % 2;
    const Words key(p.round_key(round)), high_key(p.round_key(round) >> 32);
    for (std::size_t k = 0; k < abreast; ++k) {
      const Words product = product_of_low_words(cell[1 - moved][k] ^ key, first);
      const Words hash = high_words(product_of_low_words(high_words(product) ^ product ^ high_key, second));
      cell[moved][k] = within(cell[moved][k] + (product_of_low_words(hash, sides[moved]) >> 32), sides[moved]);
    }
  }
  for (std::size_t k = 0; k < abreast; ++k)
    (product_of_low_words(cell[0][k], sides[1]) + cell[1][k]).store_unaligned(row + k * Lanes::size);
}

/// stratum[i] = p(place + i) for i < n, at most permuted_strip and a multiple of 8; places from the size on begin anew.
constexpr std::size_t permuted_strip = 512;
inline void permute_lanes(const random::Permutation& p, std::uint64_t place, std::uint64_t* stratum, std::size_t n) {
  static_assert(permuted_strip % feistel_step == 0);
  alignas(64) std::array<std::uint64_t, permuted_strip> columns{};
  std::uint64_t row = place / p.columns(), column = place % p.columns();
  for (std::size_t i = 0; i < n;) {
    const std::uint64_t run = std::min({std::uint64_t{n - i}, p.columns() - column, p.size() - place});
    for (std::uint64_t j = 0; j < run; ++j) stratum[i + j] = row, columns[i + j] = column + j;
    i += run, place += run, column += run;
    if (column == p.columns()) column = 0, ++row;
    if (place == p.size()) place = row = column = 0;
  }
  for (std::size_t i = 0; i < n; i += feistel_step) feistel_lanes(p, stratum + i, columns.data() + i);
  for (std::size_t i = 0; i < n; ++i)
    if (stratum[i] >= p.size()) stratum[i] = p(stratum[i]); // at most one in p.columns()
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
    permute_lanes(p, place, stratum.data(), count);
    place = (place + count) % p.size();
    for (std::size_t i = 0; i < count; i += Lanes::size) {
      double* const at = out + start + i;
      const Lanes jitter = (xsimd::floor(Lanes::load_unaligned(at) * Lanes(scale)) + half) * Lanes(1 / scale);
      ((to_double<Lanes>(Words::load_unaligned(&stratum[i])) + jitter) / total).store_unaligned(at);
    }
  }
}

} // namespace gumshoe::quantities
