#include "math/variance_ratio.h"

#include <algorithm>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

namespace gumshoe {

double p_of_variance_ratio(double ratio, double above, double below) {
  using boost::math::complement;
  constexpr double practically_infinite = 1e6;
  ratio = std::clamp(ratio, 0.0, 1e100);
  if (below < practically_infinite) return cdf(complement(boost::math::fisher_f(above, below), ratio));
  return cdf(complement(boost::math::chi_squared(above), above * ratio));
}

} // namespace gumshoe
