/// Winsorises residuals, so that an outlier does not decide.
#include <algorithm>
#include <cmath>

#include "tracing/criteria.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

double robust_scale(std::vector<double>& sizes) {
  const auto at = [&](std::size_t rank) {
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(rank), sizes.end());
    return sizes[rank];
  };
  const std::size_t n = sizes.size(), few = 3;
  const double middle = at(n / 2) / 0.6744897501960817; // quantiles of absolute normal values
  const double large = at(n > 10 * few ? n - n / 10 : n - std::min(n, few));
  return large > criteria.winsor_limit * middle ? large / 1.6448536269514722 : middle;
}

Matrix Whitened::winsorised(const Matrix& residuals, Vector* scale, Matrix* weight) const {
  Matrix white = in_units(residuals);
  const Matrix left = elimination_->projected(white);
  const auto freedom = static_cast<double>(degrees_of_freedom());
  const double lost = freedom / static_cast<double>(residuals.rows());
  if (scale) scale->resize(residuals.cols());
  if (weight) *weight = Matrix::Ones(residuals.rows(), residuals.cols());
  std::vector<double> sizes(index(residuals.rows()));
  const auto k = index(design_.indications);
  for (Index j = 0; j < residuals.cols(); ++j) {
    for (Index i = 0; i < residuals.rows(); ++i) sizes[index(i)] = std::fabs(left(i, j));
    const double s = robust_scale(sizes) / std::sqrt(lost);
    const double rms = std::sqrt(left.col(j).squaredNorm() / freedom);
    // Nearly all equal: no robust scale.
    const double used = s > 1e-9 * rms ? s : rms;
    if (scale) (*scale)[j] = used;
    for (Index i = 0; i < residuals.rows(); ++i) {
      const double size = std::fabs(left(i, j)), bound = criteria.winsor_limit * used;
      if (size <= bound) continue;
      white(i, j) -= left(i, j) * (1 - bound / size);
      if (weight) (*weight)(i, j) = bound / size;
    }
  }
  // Back to the readings' own units.
  Matrix out = white;
  for (Index i = 0; i < out.rows(); i += k) {
    const auto place = index(rows_[index(i)]) / design_.indications;
    out.middleRows(i, k) = (design_.local[place].triangularView<Eigen::Lower>() * white.middleRows(i, k)).eval();
  }
  return out;
}

} // namespace gumshoe::tracing
