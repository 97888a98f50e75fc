#pragma once
/// The least-squares fit behind a joint evaluation: what its own equations say of the covariance of its unknowns.
#include <cmath>
#include <optional>
#include <vector>

#include "models/model.h"

namespace gumshoe::models {

/// SI; matrices are row-major, in the order of `measurands`.
struct Fit {
  std::vector<std::size_t> measurands; ///< rows of the evaluation's measurands that are its unknowns
  std::size_t residual_rms = 0;        ///< row of the root mean square of its residuals
  std::size_t equations = 0;           ///< indications, of equal weights or whitened
  double degrees_of_freedom = 0;       ///< expected sum of squares of residuals of unit variance
  double squares = std::nan("");       ///< of the residuals, whitened if they are; NaN: nothing was read
  bool whitened = false;               ///< weighted with the covariance matrix that the scenario declares
  std::vector<double> cofactors;       ///< covariance of the unknowns where the equations have unit variance
  std::vector<bool> determined;        ///< false: the readings leave it undetermined
};

/// Throws nothing; null where a joint evaluation is no fit, or its model does not tell. Without indications the call
/// asks for the fit of what the machine of its quantities would read.
using FitFunction = std::optional<Fit> (*)(const BlockCall&);
FitFunction fit_function(const Model& model);

} // namespace gumshoe::models
