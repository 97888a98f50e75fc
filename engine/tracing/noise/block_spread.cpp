#include "tracing/noise/block_spread.h"

#include <algorithm>
#include <cmath>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Standard deviation of normal numbers with this median of their sizes; 0 if there are too few.
double by_median(std::vector<double>& sizes) {
  if (sizes.size() < criteria.readings_of_block) return 0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle / 0.6744897501960817;
}

} // namespace

BlockSpread block_spread(const Matrix& residuals, const std::vector<std::size_t>& block, std::size_t blocks) {
  const Matrix zero = Matrix::Zero(index(blocks), residuals.cols());
  BlockSpread out{zero, zero, zero};
  for (Index j = 0; j < residuals.cols(); ++j)
    for (std::size_t b = 0; b < blocks; ++b) {
      std::vector<double> own, rest;
      for (Index i = 0; i < residuals.rows(); ++i)
        (block[index(i)] == b ? own : rest).push_back(std::fabs(residuals(i, j)));
      const auto count = static_cast<double>(own.size());
      const double here = by_median(own), there = by_median(rest);
      out.typical(index(b), j) = here;
      out.others(index(b), j) = there;
      if (here > there && there > 0) out.statistic(index(b), j) = count * std::pow(std::log(here / there), 2);
    }
  return out;
}

} // namespace gumshoe::tracing
