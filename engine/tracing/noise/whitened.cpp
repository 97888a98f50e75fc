#include "tracing/noise/whitened.h"

#include <algorithm>
#include <cmath>

#include "tracing/noise/sparse_columns.h"

namespace gumshoe::tracing {
Whitened::Whitened(const Design& d, std::vector<Index> rows, std::vector<Index> use, const CovarianceModel& model)
    : design_(d), rows_(std::move(rows)), use_(std::move(use)), model_(model),
      columns_(std::make_shared<const Columns>(columns_in_units())) {
  eliminate();
}

Whitened::Whitened(const Whitened& other, const CovarianceModel& model)
    : design_(other.design_), rows_(other.rows_), use_(other.use_), model_(model), columns_(other.columns_) {
  eliminate();
}

Whitened::Columns Whitened::columns_in_units() const {
  const Design& d = design_;
  SparseColumns columns(d, rows_);
  for (const Index j : use_) columns.add(d.fixed.col(j));
  columns.add(d.random);
  Columns out{columns.rows(), 0};
  for (const Index j : use_) {
    double square = 0;
    for (const Index row : rows_) {
      const double x = d.fixed(row, j) / d.reference[index(row) % d.indications];
      square += x * x;
    }
    if (square > 0) out.log_squares += std::log(square);
  }
  return out;
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

/// Z of the variance component.
std::vector<SparseRow> Whitened::scatter_in_units(const std::vector<int>& group) const {
  const std::size_t k = design_.indications;
  std::vector<SparseRow> out(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); i += k) {
    Matrix own = Matrix::Zero(index(k), index(k));
    for (std::size_t a = 0; a < k; ++a)
      if (group[i + a] >= 0) own(index(a), index(a)) = scatter_unit(i + a);
    design_.local[index(rows_[i]) / k].triangularView<Eigen::Lower>().solveInPlace(own);
    for (std::size_t a = 0; a < k; ++a)
      for (std::size_t b = 0; b <= a; ++b)
        if (const double x = own(index(a), index(b)); x != 0) out[i + a].push_back({index(group[i + b]), x});
  }
  return out;
}

Serial Whitened::serial() const { return {model_.correlation, design_.indications}; }

void Whitened::eliminate() {
  // Roundings are independent; they are whitened as if each went with the one before.
  const double square = model_.correlation * model_.correlation;
  hidden_squares_ = tracing::hidden_squares(design_, rows_) * (1 + square) / (1 - square);
  const Design& d = design_;
  const std::size_t p = use_.size(), count = p + index(d.random.cols());
  std::size_t groups = 0;
  auto rows = columns_->rows;
  if (const auto group = scattered(); !group.empty()) {
    const auto z = scatter_in_units(group);
    scatter_.emplace(decorrelated(z, serial()));
    groups = index(*std::ranges::max_element(group) + 1);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const auto& [effect, value] : z[i]) rows[i].push_back({count + effect, value});
  }
  elimination_ = std::make_shared<const Elimination>(rows, count + groups, p, serial());
  const auto k = static_cast<double>(rows_.size()) / static_cast<double>(d.indications);
  log_determinant_ =
      static_cast<double>(d.indications) * (k - 1) * std::log(1 - model_.correlation * model_.correlation);
  for (std::size_t j = 0; j < count + groups; ++j) log_determinant_ += 2 * elimination_->log_pivot(j);
  // Columns of length one, by the same scale under every covariance model: the determinant is of the data, not of the
  // unknowns' units.
  log_determinant_ -= columns_->log_squares;
}

Matrix Whitened::in_units(Matrix x) const {
  constexpr Index together = 32; // columns that stay in the cache, with the values of a row side by side
  const auto k = index(design_.indications), n = x.rows();
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
    x.middleCols(from, count) = t.transpose();
  }
  return x;
}

Matrix Whitened::whiten_units(Matrix x) const {
  const auto k = index(design_.indications);
  const double rho = model_.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  if (rho != 0)
    for (Index j = 0; j < x.cols(); ++j)
      for (Index i = x.rows() - 1; i >= k; --i) x(i, j) = factor * (x(i, j) - rho * x(i - k, j));
  if (!scatter_) return x;
  Matrix t = x.transpose();
  scatter_->whiten(t);
  return t.transpose();
}

Matrix Whitened::coefficients(const Matrix& chosen, Matrix* covariance) const {
  const Index count = index(use_.size()) + design_.random.cols();
  if (covariance) *covariance = elimination_->covariance(count);
  return elimination_->solved(in_units(chosen)).topRows(count);
}

Matrix Whitened::overlap(const Matrix& x, Vector& squares) const {
  Matrix out = Matrix::Zero(index(use_.size()) + design_.random.cols(), x.cols());
  squares = Vector::Zero(out.rows());
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (const auto& [column, value] : columns_->rows[i]) {
      out.row(index(column)) += value * x.row(index(i));
      squares[index(column)] += value * value;
    }
  return out;
}

} // namespace gumshoe::tracing
