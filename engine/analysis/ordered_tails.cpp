#include "analysis/ordered_tails.h"

#include <array>
#include <cmath>
#include <limits>

#include <boost/sort/pdqsort/pdqsort.hpp>

#include "analysis/leaves.h"

namespace gumshoe::analysis {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Appends those of x that `beyond` holds for; branches that cannot be foretold would cost more than the stores.
template <class Beyond> void append(std::vector<double>& to, std::span<const double> x, const Beyond& beyond) {
  std::array<double, leaf_values> some;
  for (std::size_t at = 0; at < x.size(); at += leaf_values) {
    std::size_t count = 0;
    for (const double v : x.subspan(at, std::min(leaf_values, x.size() - at))) {
      some[count] = v;
      count += beyond(v) ? 1 : 0; // a NaN is not
    }
    to.insert(to.end(), some.begin(), some.begin() + static_cast<long>(count));
  }
}

std::vector<double> joined(const std::vector<std::vector<double>>& pieces) {
  std::size_t n = 0;
  for (const auto& p : pieces) n += p.size();
  std::vector<double> all;
  all.reserve(n);
  for (const auto& p : pieces) all.insert(all.end(), p.begin(), p.end());
  return all;
}

} // namespace

std::vector<double> pilot_sample(std::span<const double> x) {
  constexpr std::size_t most = 16384;
  const std::size_t step = (x.size() + most - 1) / most;
  std::vector<double> some;
  some.reserve(most);
  for (std::size_t i = 0; i < x.size(); i += step)
    if (!std::isnan(x[i])) some.push_back(x[i]);
  boost::sort::pdqsort_branchless(some.begin(), some.end());
  return some;
}

OrderedTails ordered_tails(std::span<const double> x, std::size_t valid, std::size_t tail, int threads) {
  OrderedTails t;
  t.size = valid;
  double low = inf, high = inf; // everything is low
  if (const auto pilot = pilot_sample(x); 4 * tail < valid && pilot.size() >= 1000) {
    // The pilot's rank of the bracket scatters binomially: four standard deviations out, it hardly ever misses.
    const double share = static_cast<double>(tail) / static_cast<double>(valid), m = static_cast<double>(pilot.size());
    const auto out = static_cast<std::size_t>(std::ceil(share * m + 4 * std::sqrt(share * m) + 1));
    if (2 * out < pilot.size()) low = pilot[out], high = pilot[pilot.size() - 1 - out];
  }
  if (!(low < high)) low = inf;
  const auto collect = [&] {
    std::vector<std::vector<double>> lows(parts(x.size())), highs(lows.size());
    const bool both = low < inf;
    for_parts(x, threads, [&](std::size_t part, std::span<const double> some) {
      append(lows[part], some, [&](double v) { return v <= low; });
      if (both) append(highs[part], some, [&](double v) { return v >= high; });
    });
    t.low = joined(lows);
    t.high = joined(highs);
  };
  collect();
  if (low < inf && (t.low.size() < tail || t.high.size() < tail)) {
    low = inf;
    collect();
  }
  const auto sort = [&](std::size_t side) {
    auto& tail_values = side == 0 ? t.low : t.high;
    boost::sort::pdqsort_branchless(tail_values.begin(), tail_values.end());
  };
  if (threads == 1 || parts(x.size()) == 1)
    sort(0), sort(1);
  else
    propagation::parallel_for(2, threads, sort);
  return t;
}

} // namespace gumshoe::analysis
