#include "analysis/ranked.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/leaves.h"
#include "analysis/ordered_column.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

struct Bracket {
  double low = -infinity, high = infinity;
};

/// Where the ranks lie in a sample of the values, four standard deviations of its own ranks to either side.
Bracket bracket(std::size_t n, const Fill& fill, std::size_t first_rank, std::size_t last_rank) {
  constexpr std::size_t pilots = 8192;
  if (n < 8 * pilots) return {};
  std::vector<double> pilot(pilots);
  for (std::size_t i = 0; i < pilots; i += pilot_run) fill(i * (n / pilots), std::span(&pilot[i], pilot_run));
  if (std::ranges::any_of(pilot, [](double v) { return std::isnan(v); })) return {};
  std::ranges::sort(pilot);
  constexpr double m = pilots;
  const auto end = [&](std::size_t rank, double side) {
    const double share = static_cast<double>(rank) / static_cast<double>(n);
    return share * m + side * (4 * std::sqrt(m * share * (1 - share)) + 1);
  };
  const double low = std::floor(end(first_rank, -1)), high = std::ceil(end(last_rank, 1));
  return {low < 0 ? -infinity : pilot[static_cast<std::size_t>(low)],
          high >= m ? infinity : pilot[static_cast<std::size_t>(high)]};
}

struct Inside {
  std::size_t below = 0;
  std::vector<double> values;
};

/// Adds what of a leaf lies inside the bracket, and counts what lies below it.
void add(std::span<const double> leaf, const Bracket& b, Inside& to) {
  const bool all = b.low == -infinity && b.high == infinity;
  std::array<double, leaf_values> kept;
  std::size_t within = 0;
  for (const double v : leaf) { // without branches, which could not be foretold
    to.below += v < b.low ? 1 : 0;
    kept[within] = v;
    within += all || (v >= b.low && v <= b.high) ? 1 : 0;
  }
  to.values.insert(to.values.end(), kept.begin(), kept.begin() + static_cast<long>(within));
}

/// What of the values lies inside the bracket, and how many lie below it; a NaN lies inside if all do.
Inside inside(std::size_t n, const Fill& fill, const Bracket& b, int threads) {
  std::vector<Inside> found(parts(n));
  for_ranges(n, threads, [&](std::size_t part, std::size_t first, std::size_t count) {
    std::vector<double> piece(std::min(count, piece_values));
    Inside& here = found[part];
    for (std::size_t at = 0; at < count; at += piece_values) {
      const auto some = std::span(piece).first(std::min(piece_values, count - at));
      fill(first + at, some);
      for (std::size_t from = 0; from < some.size(); from += leaf_values)
        add(some.subspan(from, std::min(leaf_values, some.size() - from)), b, here);
    }
  });
  Inside joined;
  for (const Inside& part : found) {
    joined.below += part.below;
    joined.values.insert(joined.values.end(), part.values.begin(), part.values.end());
  }
  return joined;
}

} // namespace

std::vector<double> ranked(std::size_t n, const Fill& fill, std::span<const std::size_t> ranks, int threads) {
  constexpr std::size_t few = std::size_t{1} << 19; // then what lies inside the bracket, or all, is soon kept
  Inside some;
  if (n <= 16 * few) some = inside(n, fill, bracket(n, fill, ranks.front(), ranks.back()), threads);
  if (n > few && (some.below > ranks.front() || some.below + some.values.size() <= ranks.back()))
    return values_of_ranks(Column(n, fill), n, ranks, threads);
  if (some.below > ranks.front() || some.below + some.values.size() <= ranks.back())
    some = inside(n, fill, {}, threads);
  std::vector<double> found;
  auto from = some.values.begin();
  for (const std::size_t rank : ranks) {
    const auto place = some.values.begin() + static_cast<long>(rank - some.below);
    if (place >= from) std::nth_element(from, place, some.values.end()), from = place + 1;
    found.push_back(*place);
  }
  return found;
}

} // namespace gumshoe::analysis
