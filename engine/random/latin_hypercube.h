#pragma once
/// Latin hypercube: each of `total` equal strata of every variate is hit exactly once.
#include <cstddef>
#include <cstdint>

#include "random/streams.h"

namespace gumshoe::random {

/// A keyed bijection of {0, ..., size - 1}: a Feistel network on the next even number of bits,
/// walked along its cycle until it falls inside (Black and Rogaway 2002). No memory, so the strata
/// of a block do not depend on other blocks.
class Permutation {
public:
  /// Four already pass for pseudorandom; two are a margin for very small domains.
  static constexpr std::uint64_t rounds = 6;

  Permutation(std::uint64_t size, std::uint64_t key);
  std::uint64_t operator()(std::uint64_t i) const; ///< i < size

  std::uint64_t size() const { return size_; }
  unsigned half_bits() const { return half_; } ///< of each half of the network's domain
  std::uint64_t round_key(std::uint64_t round) const { return key_ + round * 0x9e3779b97f4a7c15u; }

private:
  std::uint64_t size_, key_;
  unsigned half_;
};

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
