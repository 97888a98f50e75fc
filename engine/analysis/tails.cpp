#include "analysis/tails.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "analysis/ordered_tails.h"
#include "base/special_values.h"

namespace gumshoe::analysis {

namespace {

constexpr std::size_t least_exceedances = 1000;

/// Order statistics to go by: a share of the sample that shrinks, in a number that grows.
std::size_t tail_size(std::size_t n) { return static_cast<std::size_t>(std::pow(static_cast<double>(n), 0.6)); }

/// The k + 1 largest of side * (x - origin), in falling order.
template <class Ordered> std::vector<double> largest(const Ordered& x, double origin, double side, std::size_t k) {
  std::vector<double> tail;
  for (std::size_t i = 0; i <= k; ++i) tail.push_back(side * (x[side > 0 ? x.size - 1 - i : i] - origin));
  return tail;
}

/// Hill 1975: the reciprocal mean of ln(x_i / x_(k+1)) over the k largest. NaN if the tail does not leave the centre.
double hill(std::span<const double> falling) {
  if (falling.size() < 2 || !(falling.back() > 0)) return nan;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < falling.size(); ++i) sum += std::log(falling[i] / falling.back());
  return sum > 0 ? static_cast<double>(falling.size() - 1) / sum : infinity;
}

} // namespace

void use_median(const Column& values, Summary& s, int threads) {
  if (s.valid < 2) return;
  const double n = static_cast<double>(s.valid);
  const auto rank = [&](double r) { return static_cast<std::size_t>(std::clamp(r, 0.0, n - 1)); };
  const std::size_t middle = rank(std::floor(0.5 * n));
  const std::size_t ranks[] = {rank(0.5 * n - 0.5 * std::sqrt(n)), middle, rank(0.5 * n + 0.5 * std::sqrt(n))};
  const auto found = values_of_ranks(values, s.valid, ranks, threads);
  s.estimate = found[1];
  s.estimate_se = 0.5 * (found[2] - found[0]);
  s.estimate_is_median = true;
  s.warning = "the mean does not settle, and the estimate is the median; " + s.warning;
}

void add_tail_ranks(std::size_t valid, std::vector<RankRange>& ranks) {
  if (valid < least_exceedances) return;
  const std::size_t k = tail_size(valid);
  ranks.push_back({0, k});
  ranks.push_back({valid - 1 - k, valid - 1});
}

namespace {

/// Withholds moments that numbers of double precision do not hold, although they hold the values. Returns whether it did.
bool withhold_beyond_range(const Column& values, Summary& s, int threads) {
  if (s.valid < 2) return false;
  const bool fourth = s.valid < least_for_kurtosis || std::isfinite(s.kurtosis); // of d^4, the first to leave the range
  const double u = s.standard_uncertainty;
  const bool large = !std::isfinite(s.estimate) || !std::isfinite(u) || (!fourth && u > 1);
  const bool small = (u == 0 && s.symmetric.low < s.symmetric.high) || (!fourth && u < 1);
  if (!large && !small) return false;
  s.warning = fmt::format("{}no standard uncertainty: the values are too {} for it in double precision",
                          s.warning.empty() ? "" : s.warning + "; ", large ? "large" : "small");
  if (!std::isnan(s.symmetric.low)) s.warning += "; the ends of the interval are quantiles and remain valid";
  s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = s.monte_carlo_expanded = nan;
  s.skewness = s.kurtosis = nan;
  if (!std::isfinite(s.estimate)) use_median(values, s, threads);
  return true;
}

} // namespace

void check_tails(const Column& values, Summary& s, int threads, const KeptOrder* order) {
  s.hill_index = nan;
  if (withhold_beyond_range(values, s, threads)) return;
  if (s.valid < least_exceedances || !(s.standard_uncertainty > 0)) return;
  const bool known = order && order->has_value();
  const auto some = known && !(*order)->pilot().empty() ? (*order)->pilot() : pilot_sample(values);
  if (some.size() < least_exceedances) return;
  const std::size_t k = tail_size(s.valid);
  const double median = some[some.size() / 2];
  const OrderedTails own = known ? OrderedTails() : ordered_tails(values, s.valid, k + 1, threads);
  bool heavy = false, no_expectation = false;
  const auto below = [](double index, std::size_t used, double errors, double limit) {
    return index * (1 + errors / std::sqrt(static_cast<double>(used))) < limit;
  };
  for (const double side : {1.0, -1.0}) {
    const auto tail = known ? largest(**order, median, side, k) : largest(own, median, side, k);
    const double index = hill(tail);
    // A power law is one further out, too; outliers in a bounded cluster, or a few discrete values, are not.
    const std::size_t out_there = k / 10;
    const double far_index = hill(std::span(tail).first(out_there + 1));
    heavy |= below(index, k, 2.5, 2.25) && below(far_index, out_there, -2, 2.25);
    // An index of 1, as of 1/x through zero, cannot be told from one slightly above.
    no_expectation |= below(index, k, -2, 1) && below(far_index, out_there, -2, 1);
    if (!std::isnan(index) && !(index >= s.hill_index)) s.hill_index = index;
  }

  const double n = static_cast<double>(s.valid);
  // Sum d^4 / (sum d^2)^2: how much the largest contribute; it vanishes as 1 / n if there is a fourth moment.
  const double unsettled = s.kurtosis / n;
  if (heavy && unsettled > 1e-3) {
    s.warning = fmt::format("no standard uncertainty: the tails are so heavy that the variance does not settle in "
                            "so many samples (Hill's tail index is {:.2g}, not clearly above 2, and a variance exists "
                            "only above 2); the ends "
                            "of the interval are quantiles and remain valid",
                            s.hill_index);
    s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = nan;
    if (no_expectation) use_median(values, s, threads);
  } else if (below(s.hill_index, k, 2, 4) && unsettled > 1e-2) {
    s.tail_remark = fmt::format("heavy tails, Hill's tail index {:.2g}: below 4 the standard uncertainty has no Monte "
                                "Carlo standard error; the one stated is too small",
                                s.hill_index);
  }
}

const quantities::Variate* without_variance(const propagation::Experiment& e, const Budget& budget,
                                            const Budget* less) {
  struct Moved {
    double by = 0, most = 0; ///< sensitivity, and the larger one of the two outputs
  };
  std::map<std::string, Moved> moved;
  const auto add = [&](const Budget& of, double sign) {
    for (const Contribution& c : of.contributions) {
      Moved& m = moved[c.name];
      m.by += sign * c.sensitivity;
      m.most = std::max(m.most, std::fabs(c.sensitivity));
    }
  };
  add(budget, 1);
  if (less) add(*less, -1);
  const quantities::Variate* found = nullptr;
  for (const quantities::Variate& v : e.plan().variates) {
    const auto m = moved.find(v.name);
    if (m == moved.end() || v.distribution.family != quantities::Family::t || std::isfinite(v.distribution.variance()))
      continue;
    const bool cancels = std::fabs(m->second.by) <= 1e-12 * m->second.most; // rounding is left
    if (!cancels && (!found || v.distribution.parameters[2] < found->distribution.parameters[2])) found = &v;
  }
  return found;
}

void withhold(Summary& s, const quantities::Variate* without, const Column& values, int threads,
              const KeptOrder& order) {
  if (!without) return check_tails(values, s, threads, &order);
  s.standard_uncertainty = s.standard_uncertainty_se = s.estimate_se = nan;
  const double freedom = without->distribution.parameters[2];
  s.warning = (s.warning.empty() ? "" : s.warning + "; ") +
              fmt::format("no standard uncertainty: {} is a t with {:.3g} degree{} of freedom", without->name, freedom,
                          freedom == 1 ? "" : "s") +
              (s.warning.empty() ? "; the ends of the interval are quantiles and remain valid" : "");
  if (freedom <= 1) use_median(values, s, threads);
}

} // namespace gumshoe::analysis
