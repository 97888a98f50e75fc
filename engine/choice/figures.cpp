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

/// The p-quantile and its standard error: half the distance between the ranks one standard deviation away.
std::pair<double, double> quantile(Sorted x, double p) {
  std::ranges::sort(x);
  const double rank = std::ceil(p * static_cast<double>(x.size())) - 1, step = span(x, p);
  return {at(x, rank), 0.5 * (at(x, rank + step) - at(x, rank - step))};
}

std::size_t shortest_start(const Sorted& x, std::size_t ranks) {
  std::size_t best = 0;
  for (std::size_t r = 1; r + ranks < x.size(); ++r)
    if (x[r + ranks] - x[r] < x[best + ranks] - x[best]) best = r;
  return best;
}

/// Length of the interval from rank r on and its variance: of the difference of two quantiles, their densities from the
/// spacing of the values about them.
std::pair<double, double> length(const Sorted& x, std::size_t r, std::size_t ranks, double p) {
  const double m = static_cast<double>(x.size()), low = static_cast<double>(r), high = static_cast<double>(r + ranks);
  const auto inverse_density = [&](double rank) {
    const double a = std::max(0.0, std::floor(rank - span(x, p))), b = std::min(m - 1, std::floor(rank + span(x, p)));
    return (at(x, b) - at(x, a)) / (b - a) * m;
  };
  const double a = (low + 0.5) / m, b = (high + 0.5) / m, da = inverse_density(low), db = inverse_density(high);
  return {at(x, high) - at(x, low), (a * (1 - a) * da * da + b * (1 - b) * db * db - 2 * a * (1 - b) * da * db) / m};
}

/// Length of the shortest interval and its standard error. The shortest of many intervals of a sample is too short, for
/// it is the one that chance favours most; so each half of the sample says where the interval begins, and the other
/// half how long it is there.
std::pair<double, double> shortest_length(std::span<const double> errors, double p) {
  Sorted half[2];
  std::size_t k = 0;
  for (const double e : errors)
    if (!std::isnan(e)) half[k++ % 2].push_back(e);
  double sum = 0, variance = 0;
  std::size_t start[2], ranks[2];
  for (const int h : {0, 1}) {
    std::ranges::sort(half[h]);
    ranks[h] = analysis::covered_ranks(half[h].size(), p);
    start[h] = shortest_start(half[h], ranks[h]);
  }
  for (const int h : {0, 1}) {
    const std::size_t r = std::min(start[1 - h], half[h].size() - 1 - ranks[h]);
    const auto [l, v] = length(half[h], r, ranks[h], p);
    sum += l;
    variance += v;
  }
  return {0.5 * sum, 0.5 * std::sqrt(std::max(0.0, variance))};
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
    const double half = 0.5 * std::sqrt(1 + 1 / static_cast<double>(f.valid));
    const auto [length, error] = shortest_length(errors, p);
    f.expanded = half * length;
    f.expanded_se = half * error;
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
