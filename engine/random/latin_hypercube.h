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
  Permutation(std::uint64_t size, std::uint64_t key);
  std::uint64_t operator()(std::uint64_t i) const; ///< i < size

private:
  std::uint64_t size_, key_;
  unsigned half_;
};

/// out[i] = (stratum of sample first + i, plus a jitter from the stream) / total. first and n even;
/// samples from `total` on (padding) repeat the strata. The first n samples of a run of N are not the run of n.
void latin_hypercube(const Stream& stream, std::uint64_t total, std::uint64_t first, std::size_t n, double* out);

} // namespace gumshoe::random
