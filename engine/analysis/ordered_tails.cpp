#include "analysis/ordered_tails.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <boost/sort/pdqsort/pdqsort.hpp>

#include "analysis/leaves.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

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

std::vector<double> pilot_sample(const Column& x, std::size_t most) {
  const std::size_t step = (x.size() + most - 1) / most;
  std::vector<double> some;
  some.reserve(most + pilot_run);
  Room room;
  for (std::size_t i = 0; i < x.size(); i += step * pilot_run)
    std::ranges::copy_if(x.read(i, std::min(pilot_run, x.size() - i), room), std::back_inserter(some),
                         [](double v) { return !std::isnan(v); });
  boost::sort::pdqsort_branchless(some.begin(), some.end());
  return some;
}

OrderedTails ordered_tails(const Column& x, std::size_t valid, std::size_t tail, int threads) {
  OrderedTails t;
  t.size = valid;
  double low = infinity, high = infinity; // everything is low
  // To sort it takes less time than to pass over the values.
  const std::size_t pilots = std::clamp<std::size_t>(x.size() / 64, 1024, 16384);
  if (const auto pilot = pilot_sample(x, pilots); 4 * tail < valid && pilot.size() >= 500) {
    // The pilot's rank of the bracket scatters binomially: four standard deviations out, it hardly ever misses.
    const double share = static_cast<double>(tail) / static_cast<double>(valid), m = static_cast<double>(pilot.size());
    const auto out = static_cast<std::size_t>(std::ceil(share * m + 4 * std::sqrt(share * m) + 1));
    if (2 * out < pilot.size()) low = pilot[out], high = pilot[pilot.size() - 1 - out];
  }
  if (!(low < high)) low = infinity;
  std::vector<double> below, above;
  const auto collect = [&] {
    std::vector<std::vector<double>> lows(parts(x.size())), highs(lows.size());
    const bool both = low < infinity;
    for_parts(x, threads, [&](std::size_t part, std::span<const double> some) {
      append(lows[part], some, [&](double v) { return v <= low; });
      if (both) append(highs[part], some, [&](double v) { return v >= high; });
    });
    below = joined(lows);
    above = joined(highs);
  };
  collect();
  if (low < infinity && (below.size() < tail || above.size() < tail)) {
    low = infinity;
    collect();
  }
  const auto order = [&](std::size_t side) { (side == 0 ? t.low : t.high) = Binned(side == 0 ? below : above); };
  if (threads == 1 || parts(x.size()) == 1)
    order(0), order(1);
  else
    propagation::parallel_for(2, threads, order);
  return t;
}

std::size_t OrderedTails::shortest(std::size_t span) const {
  double least = infinity;
  std::size_t best = 0;
  const auto search = [&](std::size_t first, std::size_t last) {
    const double* const from = low.sorted(first, last);
    for (std::size_t r = first; r < last;) { // as far as one side goes
      const Binned& side = holds(r + span);
      const std::size_t end = std::min(last, &side == &low ? low.size() - span : last);
      const double* const to = side.sorted(r + span - before(r + span), end - 1 + span - before(end - 1 + span) + 1);
      for (const std::size_t begin = r; r < end; ++r)
        if (const double length = to[r - begin] - from[r - first]; length < least || (length == least && r < best))
          least = length, best = r;
    }
  };
  struct Candidate {
    double length; ///< no interval that begins in the bin is shorter
    std::size_t first, last;
  };
  std::vector<Candidate> candidates;
  for (const Binned::Bin& bin : low.bins()) {
    if (bin.first + span >= size) break;
    const std::size_t end = bin.first + span;
    candidates.push_back(
        {holds(end).bin_of(end - before(end)).least - bin.most, bin.first, std::min(bin.last, size - span)});
  }
  const auto first = std::ranges::min_element(candidates, {}, &Candidate::length);
  search(first->first, first->last);
  for (const Candidate& c : candidates)
    if (c.length <= least) search(c.first, c.last);
  return best;
}

} // namespace gumshoe::analysis
