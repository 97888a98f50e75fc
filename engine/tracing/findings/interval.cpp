#include "tracing/findings/interval.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

namespace gumshoe::tracing {
namespace {

/// P(X <= x | |X| > c) for X of mean m and unit variance, x >= c > 0.
double truncated(double x, double c, double m) {
  const boost::math::normal normal;
  const double below = boost::math::cdf(normal, -c - m);
  const double above = boost::math::cdf(boost::math::complement(normal, c - m));
  const double beyond = boost::math::cdf(boost::math::complement(normal, x - m));
  if (!(below + above > 0)) return m > 0 ? 0 : 1;
  return (below + above - beyond) / (below + above);
}

double mean_at(double x, double c, double p) {
  // Falls with the mean.
  double low = x - 40, high = x + 10;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (truncated(x, c, middle) > p ? low : high) = middle;
  }
  return (low + high) / 2;
}

} // namespace

std::pair<double, double> interval_after_selection(double x, double u, double least) {
  if (!(u > 0)) return {x, x};
  const double sign = x < 0 ? -1 : 1, z = std::fabs(x) / u, passes = std::fabs(least) / u, c = std::min(passes, z);
  double a = mean_at(z, c, 0.975), b = mean_at(z, c, 0.025);
  constexpr double quantile = 1.959963984540054;
  if (passes > z) // found by another size: what the fit says, and on the far side what chance lets pass
    a = z - quantile, b = std::max(b, z + quantile);
  else if (passes > quantile) // the test excludes zero at the search's error rate, and so does the interval
    a = std::max(a, z - passes);
  return sign > 0 ? std::pair{u * a, u * b} : std::pair{-u * b, -u * a};
}

} // namespace gumshoe::tracing
