#include "tracing/noise/design.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <boost/math/special_functions/erf.hpp>

#include "random/streams.h"

namespace gumshoe::tracing {
namespace {

/// Some readings far out, of either sign, in the place of normal ones.
void put_outliers(const Departures& d, std::uint64_t seed, Matrix& out) {
  const double core = d.core();
  const auto columns = static_cast<std::size_t>(out.cols());
  std::vector<double> u(2 * columns);
  for (Index i = 0; i < out.rows(); ++i) {
    random::uniforms({seed, static_cast<std::uint32_t>(i + 1), 4, 0}, 0, u.size(), u.data());
    for (std::size_t j = 0; j < columns; ++j) {
      double& x = out(i, static_cast<Index>(j));
      const auto which = static_cast<std::size_t>(u[columns + j] * static_cast<double>(d.sizes.size()));
      x = core * (u[j] < d.share ? std::copysign(d.sizes[std::min(which, d.sizes.size() - 1)], x) : x);
    }
  }
}

} // namespace

std::vector<Structure> structures(const Design& d, std::size_t rows) {
  std::vector<double> rho{0.0};
  // With few readings serial correlation cannot be told from a trend.
  if (rows / d.indications >= 12) rho = {0.0, 0.2, 0.4, 0.6, 0.8};
  std::vector<Structure> out;
  for (const double r : rho) out.push_back({r, -1, 0});
  for (std::size_t c = 0; c < d.scatter.size(); ++c)
    for (const double ratio : {0.35, 0.7, 1.4, 2.8, 6.0, 15.0, 50.0})
      for (const double r : rho) {
        out.push_back({r, static_cast<int>(c), ratio});
        for (int i = 0; i < static_cast<int>(d.indications) && d.indications > 1 && ratio > 0.5 && ratio < 10; ++i)
          out.push_back({r, static_cast<int>(c), ratio, i});
      }
  return out;
}

Matrix normals(std::size_t rows, std::size_t columns, std::uint64_t seed, std::uint16_t purpose) {
  const std::size_t even = (columns + 1) / 2 * 2;
  Matrix out(static_cast<Index>(rows), static_cast<Index>(columns));
  std::vector<double> u(even);
  for (std::size_t i = 0; i < rows; ++i) {
    random::uniforms({seed, static_cast<std::uint32_t>(i + 1), purpose, 0}, 0, even, u.data());
    for (std::size_t j = 0; j < columns; ++j)
      out(static_cast<Index>(i), static_cast<Index>(j)) = -1.4142135623730951 * boost::math::erfc_inv(2 * u[j]);
  }
  return out;
}

double Departures::core() const {
  double square = 0;
  for (const double size : sizes) square += std::pow(std::min(size, far_out), 2) / static_cast<double>(sizes.size());
  return sizes.empty() ? 1 : 1 / std::sqrt(1 + share * (square - 1));
}

Whitened::Whitened(const Design& d, std::vector<Index> rows, const std::vector<Index>& use, const Structure& s)
    : design_(d), rows_(std::move(rows)), use_(use), structure_(s) {
  const auto n = static_cast<Index>(rows_.size());
  fixed_ = use_.size();
  random_ = static_cast<std::size_t>(d.random.cols());
  const auto k = static_cast<double>(rows_.size()) / static_cast<double>(d.indications);
  log_determinant_ = static_cast<double>(d.indications) * (k - 1) * std::log(1 - s.correlation * s.correlation);
  if (const auto group = scattered(); !group.empty()) filter_scatter(group);
  const auto p = static_cast<Index>(fixed_), q = static_cast<Index>(random_);
  Matrix top(n, p + q);
  for (Index j = 0; j < p; ++j)
    for (Index i = 0; i < n; ++i)
      top(i, j) = d.fixed(rows_[static_cast<std::size_t>(i)], use_[static_cast<std::size_t>(j)]);
  for (Index i = 0; i < n; ++i) top.row(i).tail(q) = d.random.row(rows_[static_cast<std::size_t>(i)]);
  stacked_ = Matrix::Zero(n + q, p + q);
  stacked_.topRows(n) = whiten(std::move(top));
  stacked_.bottomRightCorner(q, q).setIdentity();
  // Columns of length one: the determinant below is of the data, not of the unknowns' units.
  Matrix scaled = stacked_;
  if (p + q == 0) {
    basis_ = Matrix::Zero(n, 0);
    return;
  }
  for (Index j = 0; j < p; ++j) {
    // The same scale under every structure.
    double square = 0;
    for (Index i = 0; i < n; ++i) {
      const Index row = rows_[static_cast<std::size_t>(i)];
      const double x =
          d.fixed(row, use_[static_cast<std::size_t>(j)]) / d.reference[static_cast<std::size_t>(row) % d.indications];
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
  if (structure_.scatter < 0 || !(structure_.ratio > 0)) return {};
  const Grouping& g = design_.scatter[static_cast<std::size_t>(structure_.scatter)];
  std::vector<int> number(g.groups.size() * design_.indications, -1), out;
  int count = 0;
  for (const Index row : rows_) {
    const auto r = static_cast<std::size_t>(row), indication = r % design_.indications;
    const bool moved = structure_.indication < 0 || indication == static_cast<std::size_t>(structure_.indication);
    int& own = number[g.group[design_.reading[r]] * design_.indications + indication];
    if (moved && own < 0) own = count++;
    out.push_back(moved ? own : -1);
  }
  return out;
}

double Whitened::scatter_unit(std::size_t row) const {
  return structure_.ratio * design_.reference[static_cast<std::size_t>(rows_[row]) % design_.indications];
}

/// Z of the variance component, its rows whitened as all are.
void Whitened::filter_scatter(const std::vector<int>& group) {
  const std::size_t k = design_.indications;
  const double rho = structure_.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  Innovations::Rows z(rows_.size());
  Matrix before;
  for (std::size_t i = 0; i < rows_.size(); i += k) {
    const Matrix& local = design_.local[static_cast<std::size_t>(rows_[i]) / k];
    Matrix own = Matrix::Zero(static_cast<Index>(k), static_cast<Index>(k));
    for (std::size_t a = 0; a < k; ++a)
      if (group[i + a] >= 0) own(static_cast<Index>(a), static_cast<Index>(a)) = scatter_unit(i + a);
    local.triangularView<Eigen::Lower>().solveInPlace(own);
    const auto add = [&](std::size_t row, std::size_t from, const Matrix& w, double times) {
      for (std::size_t b = 0; b < k; ++b) {
        const double x = times * w(static_cast<Index>(row - i), static_cast<Index>(b));
        if (x == 0) continue;
        const auto effect = static_cast<std::size_t>(group[from + b]);
        auto& here = z[row];
        const auto same = std::find_if(here.begin(), here.end(), [&](const auto& e) { return e.first == effect; });
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

Matrix Whitened::take(const Matrix& all) const {
  Matrix out(static_cast<Index>(rows_.size()), all.cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) out.row(static_cast<Index>(i)) = all.row(rows_[i]);
  return out;
}

Matrix Whitened::whiten(Matrix x) const {
  constexpr Index together = 32; // columns that stay in the cache, a row's values side by side
  const auto k = static_cast<Index>(design_.indications), n = x.rows();
  const double rho = structure_.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  Matrix t;
  for (Index from = 0; from < x.cols(); from += together) {
    const Index count = std::min(together, x.cols() - from);
    t = x.middleCols(from, count).transpose();
    for (Index i = 0; i < n; i += k) {
      const Matrix& local =
          design_.local[static_cast<std::size_t>(rows_[static_cast<std::size_t>(i)]) / design_.indications];
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

Matrix Whitened::solve_all(const Matrix& extra, const Matrix& y, Matrix* covariance) const {
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
  const Eigen::ColPivHouseholderQR<Matrix> qr(a);
  const Matrix x = qr.solve(b);
  if (covariance) {
    const Eigen::CompleteOrthogonalDecomposition<Matrix> cod(a.transpose() * a);
    const Matrix full = scale.asDiagonal() * Matrix(cod.pseudoInverse()) * scale.asDiagonal();
    *covariance = (full + full.transpose()) / 2; // equal to the last bit
  }
  return scale.asDiagonal() * x;
}

/// What declared draws do beyond their straight lines, as a turning mill's readings that jump from tooth to tooth.
void Whitened::add_bends(const Matrix& z, Matrix& out) const {
  for (std::size_t c = 0; c < design_.bent.size(); ++c) {
    if (design_.bent[c] < 0) continue;
    const Matrix& table = design_.bends[static_cast<std::size_t>(design_.bent[c])];
    const auto column = static_cast<Index>(c);
    for (Index j = 0; j < out.cols(); ++j) {
      const Index node = nearest_bend_node(z(column, j));
      for (std::size_t i = 0; i < rows_.size(); ++i)
        if (design_.random(rows_[i], column) != 0) out(static_cast<Index>(i), j) += table(rows_[i], node);
    }
  }
}

Matrix Whitened::draw(std::size_t n, std::uint64_t seed, const Departures& departures) const {
  const auto k = static_cast<Index>(design_.indications);
  Matrix out = normals(rows_.size(), n, seed, 1);
  const double rho = structure_.correlation, factor = std::sqrt(1 - rho * rho);
  if (rho != 0)
    for (Index i = k; i < out.rows(); ++i) out.row(i) = rho * out.row(i - k) + factor * out.row(i);
  if (departures.share > 0) put_outliers(departures, seed, out);
  for (Index i = 0; i < out.rows(); i += k) {
    const auto place = static_cast<std::size_t>(rows_[static_cast<std::size_t>(i)]) / design_.indications;
    const Matrix& local = design_.straight.empty() ? design_.local[place] : design_.straight[place];
    out.middleRows(i, k) = (local.triangularView<Eigen::Lower>() * out.middleRows(i, k)).eval();
  }
  if (random_ > 0) {
    const Matrix z = normals(random_, n, seed, 2);
    out += take(design_.random) * z;
    add_bends(z, out);
  }
  if (const auto group = scattered(); !group.empty()) {
    const int groups = *std::max_element(group.begin(), group.end()) + 1;
    const Matrix z = normals(static_cast<std::size_t>(groups), n, seed, 3);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (group[i] < 0) continue;
      const auto row = static_cast<Index>(i);
      if (departures.scatter.size() == 0)
        out.row(row) += scatter_unit(i) * z.row(group[i]);
      else
        for (Index j = 0; j < out.cols(); ++j)
          out(row, j) += departures.scatter(rows_[i], nearest_bend_node(z(group[i], j)));
    }
  }
  return out;
}

std::vector<Index> independent(const Design& d, const std::vector<Index>& rows) {
  Matrix all(static_cast<Index>(rows.size()), d.fixed.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double u = d.reference[static_cast<std::size_t>(rows[i]) % d.indications];
    all.row(static_cast<Index>(i)) = d.fixed.row(rows[i]) / u;
  }
  // In the order in which they are declared: what earlier ones explain is left out.
  std::vector<Index> out;
  Matrix basis(all.rows(), 0);
  for (Index j = 0; j < all.cols(); ++j) {
    const double length = all.col(j).norm();
    if (!(length > 0)) continue;
    Vector x = all.col(j) / length;
    for (int pass = 0; pass < 2; ++pass) x -= basis * (basis.transpose() * x);
    if (x.norm() < 1e-7) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = x.normalized();
    out.push_back(j);
  }
  return out;
}

} // namespace gumshoe::tracing
