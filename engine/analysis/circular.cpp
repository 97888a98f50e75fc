#include "analysis/circular.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "analysis/ordered_sum.h"
#include "analysis/summary.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double turn = 2 * std::numbers::pi;

double square(double x) { return x * x; }

/// Into (-pi, pi].
double wrapped(double angle) {
  const double x = std::remainder(angle, turn);
  return x <= -std::numbers::pi ? x + turn : x;
}

} // namespace

CircularSummary circular_summary(std::span<const double> angles, double p) {
  CircularSummary c;
  std::vector<double> valid;
  for (const double a : angles)
    if (std::isfinite(a)) valid.push_back(a);
  const std::size_t m = valid.size();
  if (m < 2) {
    c.mean_direction = c.resultant_length = c.standard_deviation = c.low = c.high = nan;
    c.mean_direction_se = c.resultant_length_se = c.standard_deviation_se = nan;
    c.remark = "too few valid samples";
    return c;
  }
  const double n = static_cast<double>(m);
  const double x = ordered_sum(m, [&](std::size_t i) { return std::cos(valid[i]); }) / n;
  const double y = ordered_sum(m, [&](std::size_t i) { return std::sin(valid[i]); }) / n;
  c.mean_direction = std::atan2(y, x);
  c.resultant_length = std::min(1.0, std::hypot(x, y));
  // For close angles 1 - R loses its digits; R is therefore computed from the deviations.
  const double versed = ordered_sum(m,
                                    [&](std::size_t i) {
                                      const double half = std::sin(0.5 * (valid[i] - c.mean_direction));
                                      return 2 * half * half;
                                    }) /
                        n;
  c.standard_deviation = std::sqrt(std::max(0.0, -2 * std::log1p(-std::min(versed, 1.0))));
  // To first order the direction errs by mean sin d / R, R by the error of mean cos d, d the deviations.
  const double across =
      ordered_sum(m, [&](std::size_t i) { return square(std::sin(valid[i] - c.mean_direction)); }) / n;
  const double along = ordered_sum(m,
                                   [&](std::size_t i) {
                                     const double half = std::sin(0.5 * (valid[i] - c.mean_direction));
                                     return square(2 * half * half - versed);
                                   }) /
                       n;
  c.mean_direction_se = std::sqrt(across / n) / c.resultant_length;
  c.resultant_length_se = std::sqrt(along / n);
  c.standard_deviation_se =
      c.standard_deviation > 0 ? c.resultant_length_se / (c.resultant_length * c.standard_deviation) : 0;

  std::vector<double> around(m);
  std::size_t crossed = 0;
  const double home = std::round((valid[0] - c.mean_direction) / turn);
  for (std::size_t i = 0; i < m; ++i) {
    around[i] = wrapped(valid[i] - c.mean_direction);
    if (std::round((valid[i] - c.mean_direction) / turn) != home) ++crossed;
  }
  crossed = std::min(crossed, m - crossed);
  std::ranges::sort(around);
  const std::size_t q = covered_ranks(m, p);
  double best = turn;
  for (std::size_t r = 0; r < m; ++r) {
    const double end = r + q < m ? around[r + q] : around[r + q - m] + turn;
    if (end - around[r] < best) {
      best = end - around[r];
      c.low = wrapped(around[r] + c.mean_direction);
    }
  }
  c.high = c.low + best;

  if (best > 0.5 * turn)
    c.remark = fmt::format("the angle spreads over more than half the circle (resultant length {:.2g}): mean and "
                           "interval on the line depend on where the circle is cut",
                           c.resultant_length);
  else if (crossed > 0)
    c.remark = fmt::format("{:.2g} % of the samples lie across the cut of the circle: mean, standard uncertainty and "
                           "interval on the line are misleading",
                           100 * static_cast<double>(crossed) / n);
  return c;
}

std::vector<CircularSummary> circular_summaries(const propagation::Experiment& e, const ValuesOf& values, int threads) {
  std::vector<std::size_t> angles;
  for (std::size_t o = 0; o < e.outputs().size(); ++o)
    if (e.outputs()[o].si_unit == "rad") angles.push_back(o);
  std::vector<CircularSummary> summaries(angles.size());
  propagation::parallel_for(angles.size(), threads, [&](std::size_t i) {
    summaries[i] = circular_summary(values(angles[i]), e.scenario().analysis.coverage_probability);
    summaries[i].output = e.outputs()[angles[i]];
  });
  return summaries;
}

} // namespace gumshoe::analysis
