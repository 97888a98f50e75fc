#include "math/parameter_covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace gumshoe::least_squares {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The same subspace with as few members per vector as elimination gives; rows are vectors.
Eigen::MatrixXd sparse(Eigen::MatrixXd basis) {
  std::vector<bool> leads(static_cast<std::size_t>(basis.cols()), false);
  for (Eigen::Index k = 0; k < basis.rows(); ++k) {
    Eigen::Index row = k, column = 0;
    double largest = -1;
    for (Eigen::Index i = k; i < basis.rows(); ++i)
      for (Eigen::Index j = 0; j < basis.cols(); ++j)
        if (!leads[static_cast<std::size_t>(j)] && std::fabs(basis(i, j)) > largest * (1 + 1e-9)) {
          largest = std::fabs(basis(i, j));
          row = i;
          column = j;
        }
    basis.row(k).swap(basis.row(row));
    leads[static_cast<std::size_t>(column)] = true;
    basis.row(k) /= basis(k, column);
    for (Eigen::Index i = 0; i < basis.rows(); ++i)
      if (i != k) basis.row(i) -= basis(i, column) * basis.row(k);
  }
  return basis;
}

Direction direction(const Eigen::VectorXd& v, const Eigen::VectorXd& length) {
  Direction out;
  const double largest = v.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < v.size(); ++j) {
    const double share = v[j] / largest;
    out.share.push_back(std::fabs(share) < 1e-7 ? 0 : share);
    out.change.push_back(out.share.back() == 0 ? 0 : length[j] > 0 ? share / length[j] : share);
  }
  return out;
}

} // namespace

ParameterCovariance parameter_covariance(const std::vector<double>& jacobian, std::size_t rows, std::size_t columns,
                                         const std::vector<double>& magnitude, double tolerance) {
  const auto n = static_cast<Eigen::Index>(rows), p = static_cast<Eigen::Index>(columns);
  Matrix scaled = Matrix::Zero(std::max(n, p), p);
  scaled.topRows(n) = Eigen::Map<const Matrix>(jacobian.data(), n, p);
  Eigen::VectorXd length(p), effect(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    length[j] = scaled.col(j).norm();
    effect[j] = length[j] * magnitude[static_cast<std::size_t>(j)];
  }
  for (Eigen::Index j = 0; j < p; ++j) {
    if (!(effect[j] > 1e-13 * effect.maxCoeff())) length[j] = 0;
    scaled.col(j) *= length[j] > 0 ? 1 / length[j] : 0;
  }
  const Eigen::HouseholderQR<Matrix> qr(scaled);
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& s = svd.singularValues();

  ParameterCovariance out;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(p, p);
  std::vector<Eigen::Index> lost;
  for (Eigen::Index k = 0; k < p; ++k) {
    const auto v = svd.matrixV().col(k);
    if (s[0] > 0 && s[k] > tolerance * s[0]) {
      ++out.rank;
      covariance += v * v.transpose() / (s[k] * s[k]);
      out.weakest = direction(v, length);
      out.condition = s[0] / s[k];
    } else {
      lost.push_back(k);
    }
  }
  out.determined.assign(columns, true);
  if (!lost.empty()) {
    out.condition = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd basis(static_cast<Eigen::Index>(lost.size()), p);
    for (std::size_t k = 0; k < lost.size(); ++k)
      basis.row(static_cast<Eigen::Index>(k)) = svd.matrixV().col(lost[k]).transpose();
    basis = sparse(basis);
    for (Eigen::Index k = 0; k < basis.rows(); ++k) {
      out.unseen.push_back(direction(basis.row(k), length));
      for (std::size_t j = 0; j < columns; ++j)
        if (out.unseen.back().share[j] != 0) out.determined[j] = false;
    }
  }
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index j = 0; j < p; ++j)
      out.matrix.push_back(length[i] > 0 && length[j] > 0 ? covariance(i, j) / (length[i] * length[j]) : 0);
  return out;
}

} // namespace gumshoe::least_squares
