#include "tracing/judgement/apart.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/QR>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Shares below this of a column's length are rounding.
constexpr double rounding = 1e-9;

/// `columns` less what `by` explains of them over the rows.
Matrix without(const Matrix& columns, const Matrix& by, const std::vector<Index>& rows) {
  if (by.cols() == 0) return columns;
  const Matrix known = by(rows, Eigen::all);
  return columns - by * known.completeOrthogonalDecomposition().solve(columns(rows, Eigen::all));
}

/// Finds the columns that are functions of what a shape depends on: equal wherever that is equal or, where it hardly
/// ever is, a polynomial of it.
class Functions {
public:
  Functions(const Observations& o, const std::vector<std::string>& depends_on)
      : indications_(index(o.indications)), levels_(o.readings) {
    for (const Covariate& c : o.covariates)
      if (std::ranges::find(depends_on, c.name) != depends_on.end())
        for (std::size_t i = 0; i < o.readings; ++i) levels_[i].push_back(c.value[o.sequence[i]]);
    for (std::size_t i = 0; i < o.readings; ++i) first_.insert({levels_[i], index(i) * indications_});
    repeated_ = first_.size() * criteria.least_repeats <= o.readings;
  }

  bool contain(const Vector& column, const std::vector<Index>& rows) const {
    return repeated_ ? follows(column) : is_polynomial(column, rows);
  }

private:
  bool follows(const Vector& column) const {
    const double size = column.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < levels_.size(); ++i)
      for (Index k = 0; k < indications_; ++k) {
        const Index here = index(i) * indications_ + k, there = first_.at(levels_[i]) + k;
        if (!(std::abs(column[here] - column[there]) <= rounding * size)) return false;
      }
    return true;
  }

  bool is_polynomial(const Vector& column, const std::vector<Index>& rows) const {
    Matrix powers(column.size(), 1 + 3 * index(levels_[0].size()));
    for (Index row = 0; row < column.size(); ++row) {
      powers(row, 0) = 1;
      const auto& level = levels_[index(row / indications_)];
      for (std::size_t v = 0; v < level.size(); ++v)
        for (Index p = 0; p < 3; ++p) powers(row, 1 + 3 * index(v) + p) = std::pow(level[v], p + 1);
    }
    for (Index j = 0; j < powers.cols(); ++j) powers.col(j).normalize();
    return without(column, powers, rows)(rows, Eigen::all).norm() <= curved * column(rows).norm();
  }

  static constexpr double curved =
      1e-6; ///< share of a column's length that is no polynomial: a linearised model's rest
  Index indications_;
  std::vector<std::vector<double>> levels_; ///< by reading of the sequence
  std::map<std::vector<double>, Index> first_;
  bool repeated_ = false;
};

} // namespace

Candidate apart(const Candidate& shape, const JointFit& fit, const Observations& o, const std::vector<Index>& rows) {
  const Matrix& fixed = fit.design.fixed;
  const auto k = index(o.indications);
  // Each column in units of its own length, so that none is taken for rounding of another.
  Matrix all(fixed.rows(), 0);
  const auto take = [&](Matrix& into, const Vector& column) {
    const double length = column(rows).norm();
    if (!(length > 0)) return;
    into.conservativeResize(fixed.rows(), into.cols() + 1);
    into.rightCols(1) = column / length;
  };
  for (Index j = 0; j < fixed.cols(); ++j) take(all, fixed.col(j));
  Vector moved = shape.columns.cwiseAbs().rowwise().sum(), one = Vector::Zero(fixed.rows());
  for (Index i = 0; i < k; ++i)
    if (moved(Eigen::seq(i, Eigen::last, k)).norm() > 0) one(Eigen::seq(i, Eigen::last, k)).setOnes();
  Matrix own(fixed.rows(), 0);
  const Functions functions(o, shape.depends_on);
  // By label each group keeps its own size.
  const auto by = [&](const Grouping& g) { return shape.depends_on == g.labels; };
  const bool by_label = std::ranges::any_of(o.labels, by) || std::ranges::any_of(o.label_pairs, by);
  for (Index j = 0; j < all.cols() && !by_label; ++j)
    if (functions.contain(all.col(j), rows)) take(own, all.col(j));
  if (!by_label && without(one, all, rows)(rows, Eigen::all).norm() <= rounding * one(rows).norm()) take(own, one);
  const Matrix left = without(shape.columns, own, rows);
  Matrix free = without(left, all, rows)(rows, Eigen::all);
  for (Index j = 0; j < free.cols(); ++j) {
    const double length = shape.columns(rows, j).norm();
    free.col(j) /= length > 0 ? length : 1;
  }
  Eigen::ColPivHouseholderQR<Matrix> qr(free);
  qr.setThreshold(rounding);
  std::vector<Index> kept(qr.colsPermutation().indices().begin(), qr.colsPermutation().indices().begin() + qr.rank());
  std::ranges::sort(kept);
  if (kept.empty()) return shape;
  Candidate out = shape;
  out.columns = left(Eigen::all, kept);
  out.amplitudes.resize(kept.size());
  return out;
}

} // namespace gumshoe::tracing
