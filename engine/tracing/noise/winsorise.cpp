/// Winsorises residuals, so that an outlier does not decide.
#include <algorithm>
#include <cmath>
#include <numeric>

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

namespace {

/// Residuals of one data set, winsorised.
struct Winsorised {
  double scale = 0; ///< robust standard deviation
  Vector data;      ///< the data with winsorised residuals
  Vector weight;    ///< by row

  bool changed() const { return (weight.array() < 1).any(); }
};

/// @param data  in units of the noise   @param left  its residuals   @param least  least_scale()
Winsorised cut(const Eigen::Ref<const Vector>& data, const Eigen::Ref<const Vector>& left, double freedom,
               double least) {
  Winsorised out{0, data, Vector::Ones(data.size())};
  std::vector<double> sizes(index(data.size()));
  for (Index i = 0; i < data.size(); ++i) sizes[index(i)] = std::fabs(left[i]);
  const double s = std::max(least, robust_scale(sizes) / std::sqrt(freedom / static_cast<double>(data.size())));
  const double rms = std::sqrt(left.squaredNorm() / freedom);
  // Nearly all equal: no robust scale.
  out.scale = s > 1e-9 * rms ? s : rms;
  const double bound = criteria.winsor_limit * out.scale;
  for (Index i = 0; i < data.size(); ++i)
    if (const double size = std::fabs(left[i]); size > bound) {
      out.weight[i] = bound / size;
      out.data[i] -= left[i] * (1 - bound / size);
    }
  return out;
}

} // namespace

Matrix Whitened::winsorised(const Matrix& residuals, Vector* scale, Matrix* weight) const {
  const Matrix measured = in_units(residuals);
  const auto freedom = static_cast<double>(degrees_of_freedom());
  const double least = least_scale(design_, rows_);
  Matrix white = measured, left = elimination_->projected(measured);
  if (scale) scale->resize(residuals.cols());
  if (weight) *weight = Matrix::Ones(residuals.rows(), residuals.cols());
  const auto k = index(design_.indications);
  std::vector<Index> open(index(residuals.cols()));
  std::iota(open.begin(), open.end(), 0);
  for (int step = 0;; ++step) {
    std::vector<Index> next;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Index j = open[i];
      Winsorised now = cut(measured.col(j), left.col(index(i)), freedom, least);
      if (scale) (*scale)[j] = now.scale;
      if (weight) weight->col(j) = now.weight;
      const double moved = (now.data - white.col(j)).cwiseAbs().maxCoeff();
      white.col(j) = now.data;
      if (now.changed() && moved > criteria.winsor_settled * now.scale && step < criteria.most_winsor_steps)
        next.push_back(j);
    }
    open = std::move(next);
    if (open.empty()) break;
    // Residuals of what was measured from the fit of the winsorised data.
    left = elimination_->projected(white(Eigen::all, open)) + measured(Eigen::all, open) - white(Eigen::all, open);
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
