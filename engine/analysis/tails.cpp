#include "analysis/tails.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr std::size_t least = 1000;

/// Order statistics to go by: a share of the sample that shrinks, in a number that grows.
std::size_t tail_size(std::size_t n) { return static_cast<std::size_t>(std::pow(static_cast<double>(n), 0.6)); }

/// Every so-maniest value, in order: enough to place the median and a threshold that leaves out the body.
std::vector<double> thinned(std::span<const double> x) {
  constexpr std::size_t most = 16384;
  const std::size_t step = (x.size() + most - 1) / most;
  std::vector<double> some;
  for (std::size_t i = 0; i < x.size(); i += step)
    if (!std::isnan(x[i])) some.push_back(x[i]);
  std::sort(some.begin(), some.end());
  return some;
}

/// The k + 1 largest of side * (x - origin), in falling order. `guess`: a value that a little more exceed.
std::vector<double> largest(std::span<const double> x, double origin, double side, double guess, std::size_t k) {
  std::vector<double> tail;
  for (const double floor : {guess, -inf}) {
    tail.clear();
    for (const double v : x)
      if (const double d = side * (v - origin); d > floor) tail.push_back(d); // a NaN fails the test
    if (tail.size() > k) break;
  }
  if (tail.size() <= k) return {};
  std::nth_element(tail.begin(), tail.begin() + static_cast<long>(k), tail.end(), std::greater<>());
  tail.resize(k + 1);
  std::sort(tail.begin(), tail.end(), std::greater<>());
  return tail;
}

/// Hill 1975: the reciprocal mean of ln(x_i / x_(k+1)) over the k largest. NaN if the tail does not leave the centre.
double hill(std::span<const double> falling) {
  if (falling.size() < 2 || !(falling.back() > 0)) return nan;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < falling.size(); ++i) sum += std::log(falling[i] / falling.back());
  return sum > 0 ? static_cast<double>(falling.size() - 1) / sum : inf;
}

} // namespace

void check_tails(std::span<const double> values, Summary& s) {
  s.hill_index = nan;
  if (s.valid < least || !(s.standard_uncertainty > 0)) return;
  const auto some = thinned(values);
  if (some.size() < least) return;
  const std::size_t k = tail_size(s.valid), m = some.size();
  const double median = some[m / 2];
  const double share = 3 * static_cast<double>(k) / static_cast<double>(s.valid);
  const auto out = std::min(m / 2, static_cast<std::size_t>(share * static_cast<double>(m)) + 4);
  bool heavy = false;
  const auto below = [](double index, std::size_t values, double errors, double limit) {
    return index * (1 + errors / std::sqrt(static_cast<double>(values))) < limit;
  };
  for (const double side : {1.0, -1.0}) {
    const double guess = side > 0 ? some[m - 1 - out] - median : median - some[out];
    const auto tail = largest(values, median, side, guess, k);
    const double index = hill(tail);
    // A power law is one further out, too; outliers in a bounded cluster, or a few discrete values, are not.
    const std::size_t out_there = k / 10;
    heavy |= below(index, k, 2.5, 2.25) && below(hill(std::span(tail).first(out_there + 1)), out_there, -2, 2.25);
    if (!std::isnan(index) && !(index >= s.hill_index)) s.hill_index = index;
  }

  const double n = static_cast<double>(s.valid);
  // Sum d^4 / (sum d^2)^2: how much the largest contribute; it vanishes as 1 / n if there is a fourth moment.
  const double unsettled = s.kurtosis / n;
  const bool infinite = !std::isfinite(s.standard_uncertainty) || !std::isfinite(s.kurtosis);
  if (infinite || (heavy && unsettled > 1e-3)) {
    s.warning = fmt::format("no standard uncertainty: the tails are so heavy that the variance does not settle, Hill's "
                            "tail index {:.2g}, below 2 there is none; the interval's ends are quantiles and hold",
                            s.hill_index);
    s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = nan;
  } else if (below(s.hill_index, k, 2, 4) && unsettled > 1e-2) {
    s.tail_remark = fmt::format("heavy tails, Hill's tail index {:.2g}: below 4 the standard uncertainty has no Monte "
                                "Carlo standard error; the one stated is too small",
                                s.hill_index);
  }
}

} // namespace gumshoe::analysis
