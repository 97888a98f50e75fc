#include "analysis/circular.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include <fmt/format.h>

#include "analysis/complete.h"
#include "analysis/leaves.h"
#include "analysis/ordered_column.h"
#include "analysis/rounding.h"
#include "analysis/summary.h"
#include "base/special_values.h"
#include "base/units.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

namespace {

constexpr double turn = 2 * std::numbers::pi;

double square(double x) { return x * x; }

/// Into (-pi, pi].
double wrapped(double angle) {
  const double x = std::remainder(angle, turn);
  return x <= -std::numbers::pi ? x + turn : x;
}

} // namespace

CircularSummary circular_summary(const Column& angles, double p, int threads) {
  CircularSummary c;
  const Complete finite(
      {angles}, [](double a) { return std::isfinite(a); }, threads);
  const Column valid = finite.column(0);
  const std::size_t m = valid.size();
  if (m < 2) {
    c.mean_direction = c.resultant_length = c.standard_deviation = c.low = c.high = nan;
    c.mean_direction_se = c.resultant_length_se = c.standard_deviation_se = nan;
    c.remark = "too few valid samples";
    return c;
  }
  const auto sum = [&]<class Term>(const Term& term) {
    return leaf_sum<std::invoke_result_t<Term, double>>(valid, threads, [&](std::span<const double> leaf) {
      std::invoke_result_t<Term, double> some{};
      for (const double a : leaf) some += term(a);
      return some;
    });
  };
  const double n = static_cast<double>(m);
  const double x = sum([](double a) { return std::cos(a); }) / n;
  const double y = sum([](double a) { return std::sin(a); }) / n;
  c.mean_direction = std::atan2(y, x);
  c.resultant_length = std::min(1.0, std::hypot(x, y));
  // For close angles 1 - R loses its digits; R is therefore computed from the deviations.
  const auto versed_sine = [&](double a) {
    const double half = std::sin(0.5 * (a - c.mean_direction));
    return 2 * half * half;
  };
  const double versed = sum(versed_sine) / n;
  c.standard_deviation = std::sqrt(std::max(0.0, -2 * std::log1p(-std::min(versed, 1.0))));
  // To first order the direction errs by mean sin d / R, R by the error of mean cos d, d the deviations.
  const double across = sum([&](double a) { return square(std::sin(a - c.mean_direction)); }) / n;
  const double along = sum([&](double a) { return square(versed_sine(a) - versed); }) / n;
  c.mean_direction_se = std::sqrt(across / n) / c.resultant_length;
  c.resultant_length_se = std::sqrt(along / n);
  c.standard_deviation_se =
      c.standard_deviation > 0 ? c.resultant_length_se / (c.resultant_length * c.standard_deviation) : 0;

  const double home = std::round((valid[0] - c.mean_direction) / turn);
  std::size_t crossed =
      sum([&](double a) -> std::size_t { return std::round((a - c.mean_direction) / turn) != home ? 1 : 0; });
  crossed = std::min(crossed, m - crossed);
  const Column around(m, [&](std::size_t first, std::span<double> out) {
    valid.copy(first, out);
    for (double& a : out) a = wrapped(a - c.mean_direction);
  });
  const std::size_t q = covered_ranks(m, p), near = std::min(m / 2, m - q);
  const RankRange ends[] = {{0, near}, {m - 1 - near, m - 1}};
  const OrderedColumn ordered(around, m, ends, threads);
  const std::size_t r = ordered.shortest(q, turn);
  double best = turn;
  if (const double length = (r + q < m ? ordered[r + q] : ordered[r + q - m] + turn) - ordered[r]; length < best) {
    best = length;
    c.low = wrapped(ordered[r] + c.mean_direction);
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

void correct_by_circle(Summary& s, const CircularSummary& c, double p) {
  const auto& o = s.output;
  const auto shown = [&](double x) { return units::from_si(x, o.unit, o.si_unit); };
  const int d = std::max(0, decimals_for(0.1 * shown(c.standard_deviation))); // an arc may be nearly the circle
  const std::string unit = units::suffix(o.unit);
  s.statement =
      fmt::format("{}: mean direction {}{} with a standard deviation of {}{} on the circle; the shortest arc of {} "
                  "goes from {} up to {}{}.",
                  o.name, fixed(shown(c.mean_direction), d), unit, fixed(shown(c.standard_deviation), d), unit,
                  coverage_text(p), fixed(shown(c.low), d), fixed(shown(c.high), d), unit);
  s.warning += (s.warning.empty() ? "" : "; ") + c.remark;
  s.certificate.clear();
  s.expanded_uncertainty = s.coverage_factor = nan;
}

std::vector<CircularSummary> circular_summaries(const propagation::Experiment& e, const ValuesOf& values, int threads) {
  std::vector<std::size_t> angles;
  for (std::size_t o = 0; o < e.outputs().size(); ++o)
    if (e.outputs()[o].si_unit == "rad") angles.push_back(o);
  std::vector<CircularSummary> summaries(angles.size());
  side_by_side(angles.size(), e.scenario().run.samples, threads, [&](std::size_t i) {
    Room room;
    summaries[i] = circular_summary(held(values(angles[i]), room), e.scenario().analysis.coverage_probability, threads);
    summaries[i].output = e.outputs()[angles[i]];
  });
  return summaries;
}

} // namespace gumshoe::analysis
