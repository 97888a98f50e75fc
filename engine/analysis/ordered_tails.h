#pragma once
/// Exact order statistics of the tails, without sorting or copying the body.
#include <cstddef>
#include <span>
#include <vector>

namespace gumshoe::analysis {

/// What lies at and beyond a bracket on either side, in order; the bracket comes from a sample of the values and is
/// widened to all of them where it misses.
struct OrderedTails {
  std::vector<double> low, high; ///< rising; high is empty where low holds everything
  std::size_t size = 0;          ///< values in all, NaN not counted

  /// Value of rank r, from 0. Only ranks below `tail` and from size - tail on are known.
  double operator[](std::size_t rank) const {
    return rank < low.size() ? low[rank] : high[rank - (size - high.size())];
  }
};

/// `valid`: how many of the values are not NaN. `tail`: how many order statistics are wanted on either side.
OrderedTails ordered_tails(std::span<const double> values, std::size_t valid, std::size_t tail, int threads);

/// Every so-maniest value, in order, NaN left out: about 16,000 at the most.
std::vector<double> pilot_sample(std::span<const double> values);

} // namespace gumshoe::analysis
