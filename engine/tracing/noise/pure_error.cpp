#include "tracing/noise/pure_error.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr double rounding = 1e-9;

/// Orthonormal columns that span those given.
Matrix orthonormal(Matrix columns) {
  for (Index j = 0; j < columns.cols(); ++j)
    if (const double length = columns.col(j).norm(); length > 0) columns.col(j) /= length;
  if (columns.cols() == 0) return columns;
  Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  qr.setThreshold(rounding);
  Matrix out = Matrix::Identity(columns.rows(), std::min(columns.rows(), qr.rank()));
  out.applyOnTheLeft(qr.householderQ());
  return out;
}

double robust_scale(const Vector& residual, double freedom) {
  std::vector<double> sizes(index(residual.size()));
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::fabs(residual[index(i)]);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double lost = freedom / static_cast<double>(sizes.size());
  const double robust = *middle / 0.6744897501960817 / std::sqrt(lost);
  const double rms = residual.norm() / std::sqrt(freedom);
  return robust > rounding * rms ? robust : rms;
}

} // namespace

double PureError::least_freedom() { return criteria.least_pure_freedom; }

Matrix PureError::Projection::off_cells(Matrix x) const {
  for (const auto& [rows, q] : by_cell) {
    const Matrix own = x(rows, Eigen::all);
    x(rows, Eigen::all) = own - q * (q.transpose() * own);
  }
  return x;
}

Matrix PureError::Projection::operator()(const Matrix& x) const {
  Matrix out = off_cells(x);
  out -= basis * (basis.transpose() * out);
  return out;
}

Matrix PureError::whitened(const Matrix& residuals) const {
  Matrix out = residuals;
  const auto k = index(design_.indications);
  for (Index i = 0; i < out.rows(); i += k)
    design_.local[index(rows_[index(i)] / k)].triangularView<Eigen::Lower>().solveInPlace(out.middleRows(i, k));
  return out;
}

PureError::Projection PureError::projection(const std::vector<std::size_t>& cell, bool lines,
                                            const Matrix& others) const {
  Projection out;
  const auto k = index(design_.indications);
  std::map<std::size_t, std::vector<Index>> places; // by cell: first rows of its readings
  for (std::size_t i = 0; i < rows_.size() && !cell.empty(); i += index(k))
    places[cell[index(rows_[i] / k)]].push_back(index(i));
  double taken = 0;
  for (const auto& [number, first] : places) {
    const bool line = lines && first.size() >= criteria.repeats_for_line;
    std::vector<Index> rows;
    Matrix own = Matrix::Zero(index(first.size()) * k, line ? 2 * k : k);
    for (std::size_t r = 0; r < first.size(); ++r) {
      const auto at = index(r) * k;
      const Index place = rows_[index(first[r])] / k;
      for (Index j = 0; j < k; ++j) {
        rows.push_back(first[r] + j);
        own(at + j, j) = 1;
        if (line) own(at + j, k + j) = static_cast<double>(place - rows_[index(first[first.size() / 2])] / k);
      }
      design_.local[index(place)].triangularView<Eigen::Lower>().solveInPlace(own.middleRows(at, k));
    }
    out.by_cell.emplace_back(std::move(rows), orthonormal(std::move(own)));
    taken += static_cast<double>(out.by_cell.back().second.cols());
  }
  // Of a column that the cells explain only rounding is left.
  const Vector length = others.colwise().norm();
  Matrix left = out.off_cells(others);
  std::vector<Index> kept;
  for (Index j = 0; j < left.cols(); ++j)
    if (left.col(j).norm() > 1e-7 * length[j]) kept.push_back(j);
  out.basis = orthonormal(left(Eigen::all, kept));
  out.freedom = static_cast<double>(rows_.size()) - taken - static_cast<double>(out.basis.cols());
  return out;
}

PureError::PureError(const Design& d, const std::vector<Index>& rows, const Replicates& replicates,
                     const CovarianceModel& model)
    : design_(d), rows_(rows), replicates_(replicates) {
  const auto add = [&](Matrix& to, const std::vector<std::size_t>& group, bool line) {
    const Matrix more = columns_by_group(rows, d.indications, group, line);
    to.conservativeResize(Eigen::NoChange, to.cols() + more.cols());
    to.rightCols(more.cols()) = more;
  };
  Matrix own(index(rows.size()), d.fixed.cols() + d.random.cols());
  own << d.fixed(rows, Eigen::all), d.random(rows, Eigen::all);
  if (replicates.passes_are_blocks) add(own, replicates.pass, false);
  nuisance_ = whitened(own);
  Matrix drifts = own;
  if (!replicates.passes_are_blocks) add(drifts, replicates.pass, false);
  add(drifts, replicates.pass, true);
  if (model.scatter >= 0) {
    const Grouping& g = d.scatter[index(model.scatter)];
    std::vector<std::size_t> group;
    for (std::size_t i = 0; i < d.reading.size(); i += d.indications) group.push_back(g.group[d.reading[i]]);
    add(drifts, group, false);
  }
  drifts = whitened(drifts);
  pure_ = projection(replicates.cell, true, drifts);
  if (pure_.freedom < least_freedom()) pure_ = projection(replicates.cell, false, drifts);
  without_ = projection({}, false, nuisance_);
  with_ = known() ? projection(replicates.cell, false, nuisance_) : without_;
  cells_ = with_.by_cell.size();
}

PureError::Cleaned PureError::cleaned(const Matrix& residuals) const {
  Cleaned out{whitened(residuals), Vector::Constant(residuals.cols(), pure_.freedom)};
  std::vector<Index> open;
  for (Index j = 0; j < residuals.cols(); ++j) open.push_back(j);
  std::vector<std::vector<Index>> missing(index(residuals.cols()));
  constexpr int most = 100;        // what replaces a reading converges at least by half each time
  constexpr double settled = 1e-2; // of the scale: far below what counts
  for (int pass = 0; pass < most && !open.empty(); ++pass) {
    const Matrix left = pure_(out.data(Eigen::all, open));
    std::vector<Index> more;
    for (std::size_t s = 0; s < open.size(); ++s) {
      const Index j = open[s];
      auto& gone = missing[index(j)];
      double change = 0;
      for (const Index i : gone) {
        change = std::max(change, std::fabs(left(i, index(s))));
        out.data(i, j) -= left(i, index(s));
      }
      const double scale = robust_scale(left.col(index(s)), out.freedom[j]);
      bool again = change > settled * scale;
      // One at a time: the others of its cell may only look outlying beside it.
      Index worst = 0;
      if (const double size = left.col(index(s)).cwiseAbs().maxCoeff(&worst);
          !again && size > criteria.winsor_limit * scale && out.freedom[j] > least_freedom()) {
        gone.push_back(worst);
        out.freedom[j] -= 1;
        again = true;
      }
      if (again) more.push_back(j);
    }
    open = std::move(more);
  }
  return out;
}

Vector PureError::scale(const Matrix& residuals) const {
  const Cleaned clean = cleaned(residuals);
  return (pure_.squares(clean.data).array() / clean.freedom.array()).sqrt();
}

Vector PureError::lack_of_fit(const Matrix& residuals) const {
  const Matrix clean = cleaned(residuals).data;
  const Vector before = without_.squares(clean), after = with_.squares(clean);
  Vector out(before.size());
  for (Index j = 0; j < out.size(); ++j)
    out[j] = after[j] > 0 ? without_.freedom * std::max(0.0, std::log(before[j] / after[j])) : 0;
  return out;
}

double PureError::repeats(const Vector& residual) const {
  const Cleaned clean = cleaned(residual);
  const double variance = pure_.squares(clean.data)[0] / clean.freedom[0];
  const double square =
      without_.squares(clean.data)[0] - with_.squares(clean.data)[0] - (without_.freedom - with_.freedom) * variance;
  return std::sqrt(std::max(0.0, square) / static_cast<double>(rows_.size()));
}

std::vector<std::string> PureError::depends_on(const Vector& residual) const {
  const auto [clean, freedom] = cleaned(residual);
  const double variance = pure_.squares(clean)[0] / freedom[0], least = with_.squares(clean)[0];
  std::vector<std::string> out, all;
  for (std::size_t f = 0; f < replicates_.factors.size(); ++f) {
    const Projection merged = projection(replicates_.cells(f), false, nuisance_);
    const double lost = merged.freedom - with_.freedom;
    const double excess = (merged.squares(clean)[0] - least) / variance - lost;
    all.push_back(replicates_.factors[f].name);
    if (lost > 0 && excess > criteria.factor_counts * std::sqrt(2 * lost)) out.push_back(all.back());
  }
  return out.empty() ? all : out;
}

} // namespace gumshoe::tracing
