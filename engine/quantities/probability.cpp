/// Densities, distribution functions and supports of the families.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "base/special_values.h"
#include "quantities/distribution.h"

namespace gumshoe::quantities {
namespace {

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }
double normal_probability(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// Probability between a and b, from the nearer tail.
double normal_between(double a, double b) {
  return a > 0 ? normal_probability(-a) - normal_probability(-b) : normal_probability(b) - normal_probability(a);
}

/// Distribution function of a symmetric family from the probability beyond a distance y >= 0 from the centre.
template <class Beyond> double symmetric(double from_centre, Beyond&& beyond) {
  const double tail = beyond(std::abs(from_centre));
  return from_centre < 0 ? tail : 1 - tail;
}

double trapezoid_density(double y, double half_width, double top_ratio) {
  const double top = 1 / (half_width * (1 + top_ratio)), flat = half_width * top_ratio;
  return y >= half_width ? 0 : y <= flat ? top : top * (half_width - y) / (half_width - flat);
}

double trapezoid_beyond(double y, double half_width, double top_ratio) {
  const double top = 1 / (half_width * (1 + top_ratio)), flat = half_width * top_ratio;
  if (y >= half_width) return 0;
  if (y <= flat) return 0.5 - top * y;
  return top * (half_width - y) * (half_width - y) / (2 * (half_width - flat));
}

/// f(y) = ln(h / max(y, l)) / (4 d), l and h the half-widths of the shortest and the widest base:
/// the rectangular density 1/(2w) averaged over the half-width w.
double curvilinear_density(double y, double l, double h) {
  return y >= h ? 0 : std::log(h / std::max(y, l)) / (2 * (h - l));
}

double curvilinear_beyond(double y, double l, double h) {
  if (y >= h) return 0;
  const double four_d = 2 * (h - l);
  if (y <= l) return 0.5 - (y > 0 ? y * std::log(h / l) / four_d : 0);
  const double e = (h - y) / h;
  // e + (1 - e) ln(1 - e) cancels to its square term near the end
  const double flank =
      e < 1e-3 ? e * e * (1.0 / 2 + e * (1.0 / 6 + e * (1.0 / 12 + e / 20))) : e + (1 - e) * std::log1p(-e);
  return h * flank / four_d;
}

} // namespace

double Distribution::density(double x) const {
  const auto& p = parameters;
  const double centre = (p[0] + p[1]) / 2, half_width = (p[1] - p[0]) / 2, y = std::abs(x - centre);
  switch (family) {
  case Family::rectangular:
    return x < p[0] || x > p[1] ? 0 : 1 / (p[1] - p[0]);
  case Family::curvilinear_trapezoid:
    return curvilinear_density(y, half_width - p[2], half_width + p[2]);
  case Family::trapezoid:
    return trapezoid_density(y, half_width, p[2]);
  case Family::triangular:
    return trapezoid_density(y, half_width, 0);
  case Family::arcsine:
    return x <= p[0] || x >= p[1] ? 0 : 1 / (std::numbers::pi * std::sqrt((x - p[0]) * (p[1] - x)));
  case Family::normal:
    return normal_density((x - p[0]) / p[1]) / p[1];
  case Family::t:
    return boost::math::pdf(boost::math::students_t_distribution<double>(p[2]), (x - p[0]) / p[1]) / p[1];
  case Family::exponential:
    return x < 0 ? 0 : std::exp(-x / p[0]) / p[0];
  case Family::gamma:
    return x <= 0 ? 0 : boost::math::gamma_p_derivative(p[0], x / p[1]) / p[1];
  case Family::lognormal:
    return x <= 0 ? 0 : normal_density((std::log(x) - p[0]) / p[1]) / (p[1] * x);
  case Family::truncated_normal:
    if (x < p[2] || x > p[3]) return 0;
    return normal_density((x - p[0]) / p[1]) / (p[1] * normal_between((p[2] - p[0]) / p[1], (p[3] - p[0]) / p[1]));
  default:
    return 0;
  }
}

double Distribution::probability(double x) const {
  const auto& p = parameters;
  if (x < support_low()) return 0;
  if (x >= support_high()) return 1;
  const double centre = (p[0] + p[1]) / 2, half_width = (p[1] - p[0]) / 2;
  switch (family) {
  case Family::rectangular:
    return (x - p[0]) / (p[1] - p[0]);
  case Family::curvilinear_trapezoid:
    return symmetric(x - centre, [&](double y) { return curvilinear_beyond(y, half_width - p[2], half_width + p[2]); });
  case Family::trapezoid:
    return symmetric(x - centre, [&](double y) { return trapezoid_beyond(y, half_width, p[2]); });
  case Family::triangular:
    return symmetric(x - centre, [&](double y) { return trapezoid_beyond(y, half_width, 0); });
  case Family::arcsine:
    return x < centre ? 2 / std::numbers::pi * std::asin(std::sqrt((x - p[0]) / (p[1] - p[0])))
                      : 1 - 2 / std::numbers::pi * std::asin(std::sqrt((p[1] - x) / (p[1] - p[0])));
  case Family::normal:
    return normal_probability((x - p[0]) / p[1]);
  case Family::t:
    return boost::math::cdf(boost::math::students_t_distribution<double>(p[2]), (x - p[0]) / p[1]);
  case Family::exponential:
    return -std::expm1(-x / p[0]);
  case Family::gamma:
    return boost::math::gamma_p(p[0], x / p[1]);
  case Family::lognormal:
    return x <= 0 ? 0 : normal_probability((std::log(x) - p[0]) / p[1]);
  case Family::truncated_normal: {
    const double a = (p[2] - p[0]) / p[1], b = (p[3] - p[0]) / p[1];
    return normal_between(a, (x - p[0]) / p[1]) / normal_between(a, b);
  }
  case Family::discrete: {
    double sum = 0;
    for (std::size_t i = 0; i < values->size() && (*values)[i] <= x; ++i) sum += (*probabilities)[i];
    return std::min(sum, 1.0);
  }
  case Family::empirical:
    return static_cast<double>(std::upper_bound(values->begin(), values->end(), x) - values->begin()) /
           static_cast<double>(values->size());
  default:
    return 0; // constant: below its value
  }
}

double Distribution::support_low() const {
  const auto& p = parameters;
  switch (family) {
  case Family::normal:
  case Family::t:
    return -infinity;
  case Family::exponential:
  case Family::gamma:
  case Family::lognormal:
    return 0;
  case Family::curvilinear_trapezoid:
    return p[0] - p[2];
  case Family::truncated_normal:
    return p[2];
  case Family::discrete:
  case Family::empirical:
    return values->front();
  default:
    return p[0];
  }
}

double Distribution::support_high() const {
  const auto& p = parameters;
  switch (family) {
  case Family::normal:
  case Family::t:
  case Family::exponential:
  case Family::gamma:
  case Family::lognormal:
    return infinity;
  case Family::constant:
    return p[0];
  case Family::curvilinear_trapezoid:
    return p[1] + p[2];
  case Family::truncated_normal:
    return p[3];
  case Family::discrete:
  case Family::empirical:
    return values->back();
  default:
    return p[1];
  }
}

} // namespace gumshoe::quantities
