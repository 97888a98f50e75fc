#include "math/gauss_newton.h"

#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace gumshoe::least_squares {
namespace {

// Relative to the largest singular value of columns of length one; exact derivatives leave some 1e-15.
constexpr double rank_tolerance = 1e-12;

} // namespace

Tangent tangent(const Rows& rows, const Vector& z, const Vector& r, const Matrix& jacobian) {
  const Eigen::Index p = rows.parameters(), n = rows.rows();
  Tangent out;
  out.step = Vector::Zero(p);
  const Vector gradient = jacobian.transpose() * r;
  Matrix columns(std::max(n, p), p);
  columns.setZero();
  Vector length(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const bool low = z[j] <= rows.low()[j] && gradient[j] > 0, high = z[j] >= rows.high()[j] && gradient[j] < 0;
    length[j] = jacobian.col(j).norm();
    if (low || high) {
      out.held.push_back(static_cast<std::size_t>(j));
      length[j] = 0;
    } else {
      out.gradient = std::max(out.gradient, std::fabs(gradient[j]));
    }
    if (length[j] > 0) columns.col(j).head(n) = jacobian.col(j) / length[j];
  }
  // QR first: the rest of the work is p by p.
  const Eigen::HouseholderQR<Matrix> qr(columns);
  Vector padded = Vector::Zero(columns.rows());
  padded.head(n) = r;
  const Vector rotated = qr.householderQ().transpose() * padded;
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector inside = svd.matrixU().transpose() * rotated.head(p);
  double in = 0, out_of = rotated.tail(columns.rows() - p).squaredNorm();
  Vector step = Vector::Zero(p);
  for (Eigen::Index k = 0; k < p; ++k) {
    const double s = svd.singularValues()[k];
    if (s > rank_tolerance * svd.singularValues()[0]) {
      ++out.rank;
      in += inside[k] * inside[k];
      step -= inside[k] / s * svd.matrixV().col(k);
    } else {
      out_of += inside[k] * inside[k];
    }
  }
  for (Eigen::Index j = 0; j < p; ++j) {
    if (length[j] > 0) out.step[j] = step[j] / length[j];
    out.relative_step = std::max(out.relative_step, std::fabs(out.step[j]) / std::max(std::fabs(z[j]), 1.0));
  }
  out.in_plane = std::sqrt(in);
  out.off_plane = std::sqrt(out_of);
  const double freedom = static_cast<double>(n - out.rank);
  out.relative_offset =
      in == 0 ? 0
      : freedom > 0 && out_of > 0
          ? std::sqrt(in / static_cast<double>(std::max<Eigen::Index>(out.rank, 1))) / std::sqrt(out_of / freedom)
          : std::numeric_limits<double>::infinity();
  return out;
}

int polish(const Rows& rows, Vector& z, Vector& r, Matrix& jacobian) {
  constexpr int most = 60;
  Tangent here = tangent(rows, z, r, jacobian);
  for (int taken = 0; taken < most; ++taken) {
    if (here.relative_step < 1e-15) return taken;
    bool better = false;
    for (double share = 1; share > 1e-3 && !better; share /= 2) {
      const Vector next = rows.clamp(z + share * here.step);
      Vector residuals;
      Matrix slopes;
      if (!rows.evaluate(next, residuals, &slopes)) continue;
      const Tangent there = tangent(rows, next, residuals, slopes);
      // Near the minimum the cost no longer tells points apart; the remaining step does.
      const double before = r.squaredNorm(), after = residuals.squaredNorm();
      better = after < before * (1 - 1e-9) ||
               (after <= before * (1 + 1e-12) && there.relative_step < 0.9 * here.relative_step);
      if (!better) continue;
      z = next;
      r = residuals;
      jacobian = slopes;
      here = there;
    }
    if (!better) return taken;
  }
  return most;
}

} // namespace gumshoe::least_squares
