#include "tracing/noise/fisher.h"

#include <algorithm>

#include <boost/math/distributions/fisher_f.hpp>

namespace gumshoe::tracing {

double p_of_f(double ratio, double above, double below) {
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(above, below), std::max(ratio, 0.0)));
}

} // namespace gumshoe::tracing
