#include "choice/figures.h"

#include <algorithm>
#include <cmath>

#include "analysis/summary.h"

namespace gumshoe::choice {

namespace {

/// The p-quantile and its standard error: half the distance between the ranks one binomial standard deviation away.
std::pair<double, double> quantile(std::vector<double> x, double p) {
  std::ranges::sort(x);
  const double n = static_cast<double>(x.size()), step = std::max(1.0, std::sqrt(n * p * (1 - p)));
  const auto at = [&](double rank) { return x[static_cast<std::size_t>(std::clamp(std::ceil(rank) - 1, 0.0, n - 1))]; };
  return {at(p * n), 0.5 * (at(p * n + step) - at(p * n - step))};
}

Figures with_moments(std::span<const double> errors) {
  const analysis::Moments m = analysis::moments(errors);
  Figures f;
  f.valid = m.valid;
  f.failed = errors.size() - m.valid;
  f.mean = f.left = m.mean;
  f.standard_deviation = std::sqrt(m.variance);
  f.mean_se = f.standard_deviation / std::sqrt(static_cast<double>(m.valid));
  f.expanded = f.expanded_se = std::nan("");
  return f;
}

void set_magnitude(Figures& f, std::span<const double> errors, double p, double correction) {
  std::vector<double> magnitudes;
  for (const double e : errors)
    if (!std::isnan(e)) magnitudes.push_back(std::fabs(e - correction));
  if (magnitudes.size() > 1) std::tie(f.expanded, f.expanded_se) = quantile(std::move(magnitudes), p);
}

} // namespace

Figures average_figures(std::span<const double> errors, double p, scenario::Choose::Definition definition) {
  Figures f = with_moments(errors);
  if (definition == scenario::Choose::Definition::uncorrected) {
    set_magnitude(f, errors, p, 0);
  } else if (f.valid > 1) {
    const analysis::Summary s = analysis::summarise({}, errors, p);
    const double enlarged = std::sqrt(1 + 1 / static_cast<double>(f.valid));
    f.expanded = 0.5 * (s.shortest.high - s.shortest.low) * enlarged;
    f.expanded_se = 0.5 * s.shortest_length_se * enlarged;
    f.left = 0;
  }
  return f;
}

Figures case_figures(std::span<const double> errors, double p, double correction) {
  Figures f = with_moments(errors);
  set_magnitude(f, errors, p, correction);
  f.left = f.mean - correction;
  return f;
}

double probability_below(double figure, double standard_error, double limit) {
  if (std::isnan(figure)) return 0;
  if (!(standard_error > 0)) return figure <= limit ? 1 : 0;
  return 0.5 * std::erfc((figure - limit) / standard_error / std::sqrt(2.0));
}

} // namespace gumshoe::choice
