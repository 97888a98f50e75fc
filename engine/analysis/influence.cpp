#include "analysis/influence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>

#include "analysis/index_verdict.h"

namespace gumshoe::analysis {

Estimate with_interval(double value, const std::vector<double>& influence, const double* rows_of_group) {
  double groups = 0, squares = 0, fourth = 0;
  for (std::size_t g = 0; g < influence.size(); ++g) {
    groups += rows_of_group[g] > 0 ? 1 : 0;
    squares += influence[g] * influence[g];
    fourth += influence[g] * influence[g] * influence[g] * influence[g];
  }
  double half = std::numeric_limits<double>::quiet_NaN();
  if (groups >= 2) {
    // The variance of a variance is (kurtosis - 1) / G of its square, of normal values 2 / freedom.
    const double kurtosis = squares > 0 ? groups * fourth / (squares * squares) : 3;
    const double freedom = std::max(1.0, (groups - 1) * std::min(1.0, 2 / (kurtosis - 1)));
    const double t = quantile(boost::math::students_t(freedom), 0.5 + index_confidence / 2);
    half = t * std::sqrt(groups / (groups - 1) * squares);
  }
  return {value, value - half, value + half, std::string(verdict(value - half, value + half))};
}

} // namespace gumshoe::analysis
