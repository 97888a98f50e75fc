#pragma once
/// The loops of a sieve over all values, compiled once per instruction set, with equal results in all.
#include <cstddef>

namespace gumshoe::analysis {

/// Closed intervals; a NaN is in none.
struct SieveBounds {
  double low[2], high[2];
};

struct SieveKernels {
  /// Copies those of n values that are in one of the intervals, in order; returns how many. `out` has room for n.
  std::size_t (*within)(const double* x, std::size_t n, const SieveBounds& bounds, double* out);
  /// How many values lie below `low` and above `high`.
  void (*outside)(const double* x, std::size_t n, double low, double high, std::size_t& below, std::size_t& above);
};

/// Kernels for the best instruction set of this processor.
const SieveKernels& sieve_kernels();

} // namespace gumshoe::analysis
