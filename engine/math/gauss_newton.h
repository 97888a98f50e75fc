#pragma once
/// Gauss-Newton steps by QR and SVD: the last digits after Ceres, and the judgement whether a point is a minimum.
#include "math/rows.h"

namespace gumshoe::least_squares {

/// How the residuals change with the parameters at one point, and where the next step would go.
struct Tangent {
  Vector step;                   ///< by z; zero for held parameters and along directions without effect
  Eigen::Index rank = 0;         ///< of the free columns
  double in_plane = 0;           ///< length of the residuals' part in the tangent plane
  double off_plane = 0;          ///< and of the rest
  double relative_offset = 0;    ///< Bates and Watts 1981
  double relative_step = 0;      ///< largest |step_j| / max(|z_j|, 1)
  double gradient = 0;           ///< largest |J' r| over free parameters
  std::vector<std::size_t> held; ///< at a bound that the gradient pushes against
};
/// @param r, jacobian  residuals and derivatives at z, as Rows::evaluate gives them
Tangent tangent(const Rows& rows, const Vector& z, const Vector& r, const Matrix& jacobian);

/// Steps from z while they bring the minimum nearer. Returns the number of steps taken; z, r and jacobian follow.
int polish(const Rows& rows, Vector& z, Vector& r, Matrix& jacobian);

} // namespace gumshoe::least_squares
