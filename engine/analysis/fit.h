#pragma once
/// Covariance of the unknowns of a joint evaluation by the fit itself (models/fit.h), next to that of Monte Carlo.
#include <vector>

#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// A fit with equal weights has s^2 Q: Q its cofactors, s^2 = sum of squares of the residuals / degrees of freedom, of a
/// virtual experiment the mean of this over the samples. A weighted fit has Q itself, which needs no residuals.
/// Empty where the evaluation is no fit, the model does not tell its covariance, or the fit of the estimates fails.
std::vector<FitCovariance> fit_covariances(const propagation::Experiment& experiment, const Samples& samples);

} // namespace gumshoe::analysis
