#pragma once
/// Scrambled Sobol' points, one dimension at a time.
#include <array>
#include <cstddef>
#include <cstdint>

#include "random/streams.h"

namespace gumshoe::random {

/// Dimensions in Boost's table (Joe and Kuo 2008).
inline constexpr std::uint32_t sobol_dimensions = 3667;

/// One dimension of the Sobol' sequence (in natural order), under a random linear matrix scramble
/// and digital shift (Matousek 1998) of 64 bits. The scramble keeps the net's structure, makes each
/// point uniform and replications with other keys independent. The first n points of a run of N are
/// the run of n.
class SobolDimension {
public:
  SobolDimension(std::uint32_t dimension, std::uint64_t scramble_key);
  /// Plain sequence, without scramble.
  explicit SobolDimension(std::uint32_t dimension);
  /// out[i] = coordinate of point first + i; first is a multiple of 64.
  void operator()(std::uint64_t first, std::size_t n, double* out) const;

private:
  void tabulate();
  std::array<std::uint64_t, 64> direction_; ///< of bit j of the point's index, scrambled
  std::array<std::uint64_t, 64> low_;       ///< all combinations of the six low bits
  std::uint64_t shift_ = 0;
};

} // namespace gumshoe::random
