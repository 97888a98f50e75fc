#pragma once
/// A least-squares problem as plain rows, internal to math/least_squares: robust losses are folded into the residuals,
/// priors are appended as rows, and parameters are dimensionless, z = x / magnitude.
#include <Eigen/Core>

#include "math/least_squares.h"

namespace gumshoe::least_squares {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

class Rows {
public:
  /// Keeps a reference to the problem.
  explicit Rows(const Problem& problem);
  /// Number of residuals and priors.
  Eigen::Index rows() const { return n_ + m_; }
  Eigen::Index parameters() const { return p_; }
  const Vector& magnitude() const { return magnitude_; }
  /// The starting point in z.
  Vector start() const;
  /// Bounds of z; infinite where the problem has none. parameters() values each.
  const Vector& low() const { return low_; }
  const Vector& high() const { return high_; }
  /// The nearest point within the bounds.
  Vector clamp(const Vector& z) const { return z.cwiseMax(low_).cwiseMin(high_); }
  /// x in the problem's own units, from z.
  Vector parameters_of(const Vector& z) const { return z.cwiseProduct(magnitude_); }

  /// Residuals sign(r) sqrt(rho(r^2)), whose sum of squares is the robust sum, followed by those of the priors.
  ///
  /// @param z        parameters() values
  /// @param r        rows() values on return
  /// @param jacobian derivatives with respect to z, row-major rows() x parameters(); may be null
  /// @return         false if the model has no value at z or any value is not finite
  bool evaluate(const double* z, double* r, double* jacobian) const;
  bool evaluate(const Vector& z, Vector& r, Matrix* jacobian) const;
  /// Number of calls of evaluate so far.
  int evaluations() const { return evaluations_; }

private:
  const Problem& problem_;
  Eigen::Index n_, m_, p_;
  Vector magnitude_, low_, high_;
  mutable int evaluations_ = 0;
};

} // namespace gumshoe::least_squares
