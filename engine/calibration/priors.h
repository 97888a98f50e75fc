#pragma once
/// What is known of the unknowns before the fit.
#include "calibration/data.h"

namespace gumshoe::calibration {

/// Priors as whitened rows A x - b, row-major, from the unknowns' distributions and the correlations between them
/// (Pearson's coefficients). Empty if every unknown is free.
struct Priors {
  std::vector<double> matrix, target;
};
Priors priors_of(const propagation::Experiment& experiment, const std::vector<Unknown>& unknowns);

} // namespace gumshoe::calibration
