#pragma once
/// Exact order statistics of the tails, without sorting or copying the body.
#include <cstddef>
#include <vector>

#include "analysis/binned.h"
#include "analysis/column.h"

namespace gumshoe::analysis {

/// Ranks [first, last], from 0.
struct RankRange {
  std::size_t first, last;
};

/// What lies at and beyond a bracket on either side; the bracket comes from a sample of the values and is widened to
/// all of them where it misses. For one thread at a time.
struct OrderedTails {
  Binned low, high;     ///< high is empty where low holds everything
  std::size_t size = 0; ///< values in all, NaN not counted

  /// Value of rank r, from 0. Only ranks below `tail` and from size - tail on are known.
  double operator[](std::size_t rank) const { return holds(rank)[rank - before(rank)]; }

  /// The first rank r < size - span at which value r + span less value r is smallest. Sorts only where it may be.
  std::size_t shortest(std::size_t span) const;

  /// As OrderedColumn has it.
  RankRange bracket_middle(double, std::size_t spare) const { return {0, spare}; }

private:
  const Binned& holds(std::size_t rank) const { return rank < low.size() ? low : high; }
  std::size_t before(std::size_t rank) const { return rank < low.size() ? 0 : size - high.size(); }
};

/// `valid`: how many of the values are not NaN. `tail`: how many order statistics are wanted on either side.
OrderedTails ordered_tails(const Column& values, std::size_t valid, std::size_t tail, int threads);

inline constexpr std::size_t most_pilots = 16384;
/// Values are taken in runs of so many neighbours: each run is one read from the file.
inline constexpr std::size_t pilot_run = 16;
/// Runs at even distances, in order of size, NaN left out: about `most` values at the most.
std::vector<double> pilot_sample(const Column& values, std::size_t most = most_pilots);

} // namespace gumshoe::analysis
