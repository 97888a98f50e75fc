#pragma once
/// Latin hypercube: each of `total` equal strata of every variate is hit exactly once.
#include <array>
#include <cstddef>
#include <cstdint>

#include "random/streams.h"

namespace gumshoe::random {

/// A keyed bijection of {0, ..., size - 1}: a Feistel network on a table of `rows` times `columns` cells, hardly more
/// than `size` and about square, walked along its cycle until it falls inside (Black and Rogaway 2002, with additions
/// modulo the table's sides). A walk is longer than one step for at most one value in `columns`. No memory, so the
/// strata of a block do not depend on other blocks.
class Permutation {
public:
  /// Rounds move the row and the column of a cell in turn. Six show in counts of 200,000 keys, eight in those of small
  /// sizes, ten in neither.
  static constexpr std::uint64_t rounds = 10;
  /// Multipliers of a round's hash: those of Philox (Salmon et al. 2011).
  static constexpr std::uint64_t first_multiplier = 0xD2511F53, second_multiplier = 0xCD9E8D57;

  /// size below 2^63.
  Permutation(std::uint64_t size, std::uint64_t key);
  std::uint64_t operator()(std::uint64_t i) const; ///< i < rows() * columns()

  std::uint64_t size() const { return size_; }
  std::uint64_t rows() const { return rows_; }
  std::uint64_t columns() const { return columns_; }
  std::uint64_t round_key(std::uint64_t round) const { return keys_[round]; }

private:
  std::uint64_t size_, columns_, rows_;
  std::array<std::uint64_t, rounds> keys_;
};

/// Counts the ways in which strata have been permuted: samples of another generation are other samples.
inline constexpr std::uint64_t latin_generation = 2;

/// The strata of a stream: of `total` samples, sample i is in stratum strata(i).
Permutation strata(const Stream& stream, std::uint64_t total);

/// A power of two, with as many steps of the jitter inside a stratum as leave stratum + jitter exact, so that no sum
/// rounds into the next stratum.
double jitter_scale(std::uint64_t total);

/// out[i] = (stratum of sample first + i, plus a jitter from the stream) / total. first and n even;
/// samples from `total` on (padding) repeat the strata. The first n samples of a run of N are not the run of n.
/// quantities/latin_lanes.h does the same in lanes.
void latin_hypercube(const Stream& stream, std::uint64_t total, std::uint64_t first, std::size_t n, double* out);

} // namespace gumshoe::random
