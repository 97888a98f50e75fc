/// Compiled once: Eigen's decompositions take the compiler longer than the tests that use them.
#include "unit/tracing_dense.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

namespace tracing_dense {

Matrix normal_matrix(Index rows, Index columns, std::mt19937_64& chance) {
  std::normal_distribution<double> normal;
  Matrix out(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) out(i, j) = normal(chance);
  return out;
}

Design random_design(std::size_t readings, std::size_t k, Index p, Index q, std::size_t groups, std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  const auto n = static_cast<Index>(readings * k);
  Design d;
  d.indications = k;
  for (std::size_t r = 0; r < readings; ++r)
    for (std::size_t i = 0; i < k; ++i) d.reading.push_back(r);
  // Unknowns of very unequal units.
  d.fixed = normal_matrix(n, p, chance);
  for (Index j = 0; j < p; ++j) d.fixed.col(j) *= std::pow(10.0, static_cast<double>(3 * j - 4));
  d.fixed_names.assign(static_cast<std::size_t>(p), "fixed");
  d.random = 0.8e-6 * normal_matrix(n, q, chance);
  d.random_names.assign(static_cast<std::size_t>(q), "random");
  std::uniform_real_distribution<double> size(0.5e-6, 2e-6);
  for (std::size_t r = 0; r < readings; ++r) {
    Matrix l = Matrix::Zero(static_cast<Index>(k), static_cast<Index>(k));
    for (Index i = 0; i < l.rows(); ++i) {
      l(i, i) = size(chance);
      for (Index j = 0; j < i; ++j) l(i, j) = 0.4e-6;
    }
    d.local.push_back(l);
  }
  for (std::size_t i = 0; i < k; ++i) d.reference.push_back(1e-6 * static_cast<double>(i + 1));
  if (groups > 0) {
    Grouping g;
    g.name = "setup";
    for (std::size_t r = 0; r < readings; ++r) g.group.push_back(r % groups);
    for (std::size_t i = 0; i < groups; ++i) g.groups.push_back("setup " + std::to_string(i));
    d.scatter.push_back(g);
  }
  return d;
}

std::vector<Index> all_rows(const Design& d) {
  std::vector<Index> out;
  for (Index i = 0; i < d.fixed.rows(); ++i) out.push_back(i);
  return out;
}

Matrix chosen(const Matrix& all, const std::vector<Index>& rows) { return all(rows, Eigen::all); }

Matrix local_factor(const Design& d, const std::vector<Index>& rows) {
  const auto n = static_cast<Index>(rows.size());
  Matrix out = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const auto a = static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]),
                 b = static_cast<std::size_t>(rows[static_cast<std::size_t>(j)]);
      if (a / d.indications == b / d.indications)
        out(i, j) =
            d.local[a / d.indications](static_cast<Index>(a % d.indications), static_cast<Index>(b % d.indications));
    }
  return out;
}

Matrix covariance(const Design& d, const std::vector<Index>& rows, const CovarianceModel& s) {
  const auto n = static_cast<Index>(rows.size());
  const auto k = static_cast<Index>(d.indications);
  Matrix serial = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      if (i % k == j % k) serial(i, j) = i == j ? 1 : std::pow(s.correlation, std::abs(i / k - j / k));
  const Matrix l = local_factor(d, rows), u = chosen(d.random, rows);
  Matrix v = l * serial * l.transpose() + u * u.transpose();
  if (s.scatter >= 0) {
    const Grouping& g = d.scatter[static_cast<std::size_t>(s.scatter)];
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) {
        const auto a = static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]),
                   b = static_cast<std::size_t>(rows[static_cast<std::size_t>(j)]);
        const bool moved = s.indication < 0 || a % d.indications == static_cast<std::size_t>(s.indication);
        if (moved && a % d.indications == b % d.indications && g.group[d.reading[a]] == g.group[d.reading[b]])
          v(i, j) += std::pow(s.ratio * d.reference[a % d.indications], 2);
      }
  }
  return v;
}

Gls gls(const Matrix& v, const Matrix& x, const Vector& y) {
  if (x.cols() == 0) return {Vector(0), Matrix(0, 0), y.dot(v.llt().solve(y))};
  // Columns of length one before anything is inverted.
  Vector scale(x.cols());
  for (Index j = 0; j < x.cols(); ++j) scale[j] = 1 / x.col(j).norm();
  const Matrix scaled = x * scale.asDiagonal();
  const Eigen::LLT<Matrix> llt(v);
  const Matrix wx = llt.matrixL().solve(scaled);
  const Vector wy = llt.matrixL().solve(y);
  const Matrix inverse = Matrix(wx.transpose() * wx).inverse();
  Gls out;
  const Vector b = inverse * (wx.transpose() * wy);
  out.size = scale.asDiagonal() * b;
  out.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  out.squares = (wy - wx * b).squaredNorm();
  return out;
}

double ln_determinant(const Matrix& m) {
  return 2 * Matrix(Eigen::LLT<Matrix>(m).matrixL()).diagonal().array().log().sum();
}

Matrix joined(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

Candidate candidate(const Matrix& columns) {
  Candidate a;
  a.name = "made up";
  a.columns = columns;
  a.amplitudes.resize(static_cast<std::size_t>(columns.cols()));
  return a;
}

Vector outside(const Matrix& columns, const Vector& y) { return y - columns * columns.colPivHouseholderQr().solve(y); }

Matrix left_by(const Matrix& columns, const Matrix& y) {
  if (columns.cols() == 0) return y;
  Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  qr.setThreshold(1e-9);
  Matrix basis = Matrix::Identity(columns.rows(), qr.rank());
  basis.applyOnTheLeft(qr.householderQ());
  return y - basis * (basis.transpose() * y);
}

Index rank(const Matrix& m) { return Eigen::ColPivHouseholderQR<Matrix>(m).rank(); }

Matrix solved(const Matrix& v, const Matrix& f) { return v.llt().solve(f); }

} // namespace tracing_dense
