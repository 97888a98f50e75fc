#pragma once
/// One descent to a minimum by Ceres, internal to math/least_squares. The module gumshoe_ceres.so implements it and
/// alone is linked with Ceres, whose twenty libraries most commands need not load.
#include <functional>
#include <string>

namespace gumshoe::least_squares {

enum class TrustRegion { levenberg_marquardt, dogleg };

struct Descent {
  TrustRegion strategy = TrustRegion::levenberg_marquardt;
  double radius = 1e4; ///< of the first trust region
  bool scaling = true; ///< columns of the Jacobian to length one; without it steps are measured in the parameters
  int iterations = 0;  ///< at most
  int rows = 0, parameters = 0;
  const double *low = nullptr, *high = nullptr; ///< [parameters], infinite where free
  /// Residuals r[rows] at z and, unless null, jacobian[rows][parameters]. False: not defined there.
  std::function<bool(const double* z, double* r, double* jacobian)> evaluate = {};
};

struct Descended {
  std::string message; ///< in Ceres' words
  int iterations = 0;
};

/// What the module exports. z: the start, and on return where the descent ended. One thread.
extern "C" void gumshoe_descend(const Descent& descent, double* z, Descended& ended);

} // namespace gumshoe::least_squares
