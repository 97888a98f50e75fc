/// Expectations, variances, kurtoses and skewnesses of the families, by formula where one exists.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/quadrature/gauss.hpp>

#include "base/special_values.h"
#include "quantities/distribution.h"

namespace gumshoe::quantities {
namespace {

struct Moments {
  double mean, variance, kurtosis, skewness = 0;
};

double fourth(double x) { return x * x * x * x; }

/// A sum of two rectangular deviations of half-widths g and h.
Moments trapezoid(double low, double high, double top_ratio) {
  const double width = high - low, g = width / 4 * (1 + top_ratio), h = width / 4 * (1 - top_ratio);
  const double variance = (g * g + h * h) / 3;
  const double m4 = fourth(g) / 5 + 6 * (g * g / 3) * (h * h / 3) + fourth(h) / 5;
  return {(low + high) / 2, variance, m4 / (variance * variance)};
}

/// Half-width W rectangular in w +- d, times V rectangular in +-1.
Moments curvilinear_trapezoid(double low, double high, double d) {
  const double w = (high - low) / 2;
  const double variance = (w * w + d * d / 3) / 3;
  const double m4 = (fourth(w) + 2 * w * w * d * d + fourth(d) / 5) / 5;
  return {(low + high) / 2, variance, m4 / (variance * variance)};
}

/// By quadrature over the part that carries probability: the textbook formulas cancel when the
/// interval is narrow or lies in the parent's tail.
Moments truncated_normal(double mean, double u, double low, double high) {
  double a = (low - mean) / u, b = (high - mean) / u;
  const double nearest = a > 0 ? a : b < 0 ? b : 0.0; // where the density is largest
  const double reach = std::min(39.0, 40 / std::max(1.0, std::abs(nearest)));
  a = std::max(a, nearest - reach);
  b = std::min(b, nearest + reach);
  constexpr int panels = 32;
  const auto integral = [&](double centre, int power) {
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
      const double from = a + (b - a) * i / panels, to = a + (b - a) * (i + 1) / panels;
      const auto f = [&](double z) {
        return std::pow(z - centre, power) * std::exp(-(z - nearest) * (z + nearest) / 2);
      };
      sum += boost::math::quadrature::gauss<double, 20>::integrate(f, from, to);
    }
    return sum;
  };
  const double weight = integral(0, 0);
  const double centre = nearest + integral(nearest, 1) / weight;
  const double variance = integral(centre, 2) / weight;
  return {mean + u * centre, u * u * variance, integral(centre, 4) / weight / (variance * variance),
          integral(centre, 3) / weight / std::pow(variance, 1.5)};
}

Moments of_values(const Distribution& d) {
  const auto& values = *d.values;
  const auto weight = [&](std::size_t i) {
    return d.family == Family::empirical ? 1.0 / static_cast<double>(values.size()) : (*d.probabilities)[i];
  };
  const double shift = values.front(); // keeps the digits of values that differ little
  double mean = 0, m2 = 0, m3 = 0, m4 = 0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += weight(i) * (values[i] - shift);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double deviation = values[i] - shift - mean;
    m2 += weight(i) * deviation * deviation;
    m3 += weight(i) * deviation * deviation * deviation;
    m4 += weight(i) * fourth(deviation);
  }
  if (!(m2 > 0)) return {shift + mean, m2, nan, nan};
  return {shift + mean, m2, m4 / (m2 * m2), m3 / std::pow(m2, 1.5)};
}

Moments moments(const Distribution& d) {
  const auto& p = d.parameters;
  switch (d.family) {
  case Family::constant:
    return {p[0], 0, nan, nan};
  case Family::rectangular:
    return {(p[0] + p[1]) / 2, (p[1] - p[0]) * (p[1] - p[0]) / 12, 9.0 / 5};
  case Family::curvilinear_trapezoid:
    return curvilinear_trapezoid(p[0], p[1], p[2]);
  case Family::trapezoid:
    return trapezoid(p[0], p[1], p[2]);
  case Family::triangular:
    return {(p[0] + p[1]) / 2, (p[1] - p[0]) * (p[1] - p[0]) / 24, 12.0 / 5};
  case Family::arcsine:
    return {(p[0] + p[1]) / 2, (p[1] - p[0]) * (p[1] - p[0]) / 8, 3.0 / 2};
  case Family::normal:
    return {p[0], p[1] * p[1], 3};
  case Family::t:
    // With one degree of freedom or less no expectation exists; the centre stands in as the estimate.
    return {p[0], p[2] > 2 ? p[1] * p[1] * p[2] / (p[2] - 2) : infinity, p[2] > 4 ? 3 + 6 / (p[2] - 4) : nan,
            p[2] > 3 ? 0 : nan};
  case Family::exponential:
    return {p[0], p[0] * p[0], 9, 2};
  case Family::gamma:
    return {p[0] * p[1], p[0] * p[1] * p[1], 3 + 6 / p[0], 2 / std::sqrt(p[0])};
  case Family::lognormal: {
    const double s2 = p[1] * p[1];
    return {std::exp(p[0] + s2 / 2), std::expm1(s2) * std::exp(2 * p[0] + s2),
            std::exp(4 * s2) + 2 * std::exp(3 * s2) + 3 * std::exp(2 * s2) - 3,
            (std::exp(s2) + 2) * std::sqrt(std::expm1(s2))};
  }
  case Family::truncated_normal:
    return truncated_normal(p[0], p[1], p[2], p[3]);
  case Family::discrete:
  case Family::empirical:
    return of_values(d);
  }
  return {nan, nan, nan, nan};
}

} // namespace

double Distribution::mean() const { return moments(*this).mean; }
double Distribution::variance() const { return moments(*this).variance; }
double Distribution::standard_uncertainty() const {
  if (family == Family::empirical && parameters[0] > 0) return parameters[0];
  if (family != Family::t) return std::sqrt(variance());
  return parameters[3] > 0 ? parameters[3] : parameters[1];
}
double Distribution::kurtosis() const { return moments(*this).kurtosis; }
double Distribution::skewness() const { return moments(*this).skewness; }

} // namespace gumshoe::quantities
