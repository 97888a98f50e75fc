#include "tracing/planning/power.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/non_central_f.hpp>

namespace gumshoe::tracing {

namespace {
constexpr double largest = 1e16; ///< non-centrality: more than any test asks for
}

double power(double noncentrality, int k, double freedom, double alpha) {
  namespace bm = boost::math;
  if (!(noncentrality > 1e-12)) return alpha;
  if (std::isinf(freedom)) {
    if (noncentrality > 1e4) return 1; // fifty standard deviations beyond any threshold in use
    const double threshold = bm::quantile(bm::complement(bm::chi_squared(k), alpha));
    return bm::cdf(bm::complement(bm::non_central_chi_squared(k, noncentrality), threshold));
  }
  if (!(freedom >= 1)) return alpha;
  const double threshold = bm::quantile(bm::complement(bm::fisher_f(k, freedom), alpha));
  // The numerator is then all but its mean, and only the estimate of the noise is left to chance.
  if (noncentrality > 1e6) return bm::cdf(bm::chi_squared(freedom), freedom * (noncentrality / k + 1) / threshold);
  return bm::cdf(bm::complement(bm::non_central_f(k, freedom, noncentrality), threshold));
}

double noncentrality_for(double wanted, int k, double freedom, double alpha) {
  // With one degree of freedom the threshold exceeds 1 / alpha^2; with none no size suffices.
  double low = 0, high = 1e4;
  while (high < largest && power(high, k, freedom, alpha) < wanted) high *= 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (power(middle, k, freedom, alpha) < wanted ? low : high) = middle;
  }
  return high;
}

} // namespace gumshoe::tracing
