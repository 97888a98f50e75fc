#include "choice/figures.h"

#include <algorithm>
#include <cmath>

#include "analysis/summary.h"

namespace gumshoe::choice {

namespace {

using Sorted = std::vector<double>;

double at(const Sorted& x, double rank) {
  return x[static_cast<std::size_t>(std::clamp(rank, 0.0, static_cast<double>(x.size()) - 1))];
}

/// Values that a rank's scatter spans: one binomial standard deviation.
double span(const Sorted& x, double p) { return std::max(1.0, std::sqrt(static_cast<double>(x.size()) * p * (1 - p))); }

/// The value that a coverage interval reaches, and its standard error: half the distance between the ranks one standard
/// deviation away.
std::pair<double, double> quantile(Sorted x, double p) {
  std::ranges::sort(x);
  const double rank = static_cast<double>(analysis::covered_ranks(x.size(), p)), step = span(x, p);
  return {at(x, rank), 0.5 * (at(x, rank + step) - at(x, rank - step))};
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
  } else if (f.valid > 3) {
    set_magnitude(f, errors, p, f.mean);
    const double with_correction = std::sqrt(1 + 1 / static_cast<double>(f.valid));
    f.expanded *= with_correction;
    f.expanded_se *= with_correction;
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
