#include "tracing/noise/whitened.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace gumshoe::tracing {

Whitened::Whitened(const Design& d, std::vector<Index> rows, std::vector<Index> use, const CovarianceModel& model)
    : design_(d), rows_(std::move(rows)), use_(std::move(use)), model_(model) {
  const auto n = index(rows_.size()), p = index(use_.size()), q = d.random.cols();
  const auto k = static_cast<double>(rows_.size()) / static_cast<double>(d.indications);
  log_determinant_ = static_cast<double>(d.indications) * (k - 1) * std::log(1 - model.correlation * model.correlation);
  if (const auto group = scattered(); !group.empty()) filter_scatter(group);
  Matrix top(n, p + q);
  top.leftCols(p) = d.fixed(rows_, use_);
  top.rightCols(q) = take(d.random);
  stacked_ = Matrix::Zero(n + q, p + q);
  stacked_.topRows(n) = whiten(std::move(top));
  stacked_.bottomRightCorner(q, q).setIdentity();
  factorise();
}

void Whitened::factorise() {
  const auto n = index(rows_.size()), p = index(use_.size()), q = design_.random.cols();
  basis_ = Matrix::Zero(n, 0);
  if (p + q == 0) return;
  // Columns of length one, by the same scale under every covariance model: the determinant below is of the data, not of
  // the unknowns' units.
  Matrix scaled = stacked_;
  for (Index j = 0; j < p; ++j) {
    double square = 0;
    for (const Index row : rows_) {
      const double x = design_.fixed(row, use_[index(j)]) / design_.reference[index(row) % design_.indications];
      square += x * x;
    }
    if (square > 0) scaled.col(j) /= std::sqrt(square);
  }
  const Eigen::HouseholderQR<Matrix> qr(scaled);
  for (Index j = 0; j < p + q; ++j) log_determinant_ += 2 * std::log(std::fabs(qr.matrixQR()(j, j)));
  Matrix thin = Matrix::Identity(n + q, p + q);
  thin.applyOnTheLeft(qr.householderQ());
  basis_ = thin.topRows(n);
}

std::vector<int> Whitened::scattered() const {
  if (model_.scatter < 0 || !(model_.ratio > 0)) return {};
  const Grouping& g = design_.scatter[index(model_.scatter)];
  std::vector<int> number(g.groups.size() * design_.indications, -1), out;
  int count = 0;
  for (const Index row : rows_) {
    const auto r = index(row), indication = r % design_.indications;
    const bool moved = model_.indication < 0 || indication == index(model_.indication);
    int& own = number[g.group[design_.reading[r]] * design_.indications + indication];
    if (moved && own < 0) own = count++;
    out.push_back(moved ? own : -1);
  }
  return out;
}

double Whitened::scatter_unit(std::size_t row) const {
  return model_.ratio * design_.reference[index(rows_[row]) % design_.indications];
}

/// Z of the variance component, its rows whitened as all are.
void Whitened::filter_scatter(const std::vector<int>& group) {
  const std::size_t k = design_.indications;
  const double rho = model_.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  Innovations::Rows z(rows_.size());
  Matrix before;
  for (std::size_t i = 0; i < rows_.size(); i += k) {
    const Matrix& local = design_.local[index(rows_[i]) / k];
    Matrix own = Matrix::Zero(index(k), index(k));
    for (std::size_t a = 0; a < k; ++a)
      if (group[i + a] >= 0) own(index(a), index(a)) = scatter_unit(i + a);
    local.triangularView<Eigen::Lower>().solveInPlace(own);
    const auto add = [&](std::size_t row, std::size_t from, const Matrix& w, double times) {
      for (std::size_t b = 0; b < k; ++b) {
        const double x = times * w(index(row - i), index(b));
        if (x == 0) continue;
        const auto effect = index(group[from + b]);
        auto& here = z[row];
        const auto same = std::ranges::find_if(here, [&](const auto& e) { return e.first == effect; });
        if (same == here.end())
          here.push_back({effect, x});
        else
          same->second += x;
      }
    };
    for (std::size_t row = i; row < i + k; ++row) {
      add(row, i, own, rho != 0 && i > 0 ? factor : 1);
      if (rho != 0 && i > 0) add(row, i - k, before, -rho * factor);
    }
    before = std::move(own);
  }
  scatter_.emplace(z);
  log_determinant_ += scatter_->log_determinant();
}

Matrix Whitened::whiten(Matrix x) const {
  constexpr Index together = 32; // columns that stay in the cache, with the values of a row side by side
  const auto k = index(design_.indications), n = x.rows();
  const double rho = model_.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  Matrix t;
  for (Index from = 0; from < x.cols(); from += together) {
    const Index count = std::min(together, x.cols() - from);
    t = x.middleCols(from, count).transpose();
    for (Index i = 0; i < n; i += k) {
      const Matrix& local = design_.local[index(rows_[index(i)]) / design_.indications];
      for (Index a = 0; a < k; ++a) {
        for (Index b = 0; b < a; ++b) t.col(i + a) -= local(a, b) * t.col(i + b);
        t.col(i + a) /= local(a, a);
      }
    }
    if (rho != 0)
      for (Index i = n - 1; i >= k; --i) t.col(i) = factor * (t.col(i) - rho * t.col(i - k));
    if (scatter_) scatter_->whiten(t);
    x.middleCols(from, count) = t.transpose();
  }
  return x;
}

Vector Whitened::left(const Matrix& whitened) const {
  return whitened.colwise().squaredNorm().transpose() -
         (basis_.transpose() * whitened).colwise().squaredNorm().transpose();
}

Matrix Whitened::solve(const Matrix& y, Matrix* covariance, const Matrix& extra) const {
  const Index top = stacked_.rows(), p = stacked_.cols(), m = extra.cols(), n = y.rows();
  if (p + m == 0) { // nothing is free and nothing shared
    if (covariance) covariance->resize(0, 0);
    return Matrix(0, y.cols());
  }
  Matrix a = Matrix::Zero(top, p + m);
  a.leftCols(p) = stacked_;
  if (m > 0) a.topRightCorner(n, m) = extra;
  Matrix b = Matrix::Zero(top, y.cols());
  b.topRows(n) = y;
  Vector scale(p + m);
  for (Index j = 0; j < p + m; ++j) {
    const double length = a.col(j).norm();
    scale[j] = length > 0 ? 1 / length : 1;
    a.col(j) *= scale[j];
  }
  const Matrix x = Eigen::ColPivHouseholderQR<Matrix>(a).solve(b);
  if (covariance) {
    const Eigen::CompleteOrthogonalDecomposition<Matrix> cod(a.transpose() * a);
    const Matrix full = scale.asDiagonal() * Matrix(cod.pseudoInverse()) * scale.asDiagonal();
    *covariance = (full + full.transpose()) / 2; // equal to the last bit
  }
  return scale.asDiagonal() * x;
}

} // namespace gumshoe::tracing
