#pragma once
/// A least-squares problem as plain rows: losses folded into the residuals, priors appended, parameters in units of
/// their magnitudes. Internal to the least-squares door.
#include <Eigen/Core>

#include "math/least_squares.h"

namespace gumshoe::least_squares {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

class Rows {
public:
  explicit Rows(const Problem& problem);
  Eigen::Index rows() const { return n_ + m_; }
  Eigen::Index parameters() const { return p_; }
  const Vector& magnitude() const { return magnitude_; }
  Vector start() const;
  /// Bounds of z = x / magnitude.
  const Vector& low() const { return low_; }
  const Vector& high() const { return high_; }
  Vector clamp(const Vector& z) const { return z.cwiseMax(low_).cwiseMin(high_); }
  Vector parameters_of(const Vector& z) const { return z.cwiseProduct(magnitude_); }

  /// Residuals sign(r) sqrt(rho(r^2)), whose plain sum of squares is the robust one, and priors; false if undefined
  /// or not finite. `jacobian` by z, row-major; may be null.
  bool evaluate(const double* z, double* r, double* jacobian) const;
  bool evaluate(const Vector& z, Vector& r, Matrix* jacobian) const;
  int evaluations() const { return evaluations_; }

private:
  const Problem& problem_;
  Eigen::Index n_, m_, p_;
  Vector magnitude_, low_, high_;
  mutable int evaluations_ = 0;
};

} // namespace gumshoe::least_squares
