#pragma once
/// What is known of the unknowns before the fit.
#include "calibration/data.h"

namespace gumshoe::calibration {

/// Covariance of two variates of the plan, as stated (that of the copula: exact for normal variates); their SI units.
double declared_covariance(const quantities::SamplePlan& plan, std::size_t a, std::size_t b);

/// Priors as whitened rows A x - b, row-major, from the unknowns' distributions and the correlations between them (of
/// the copula: exact for normal quantities). Empty if every unknown is free.
struct Priors {
  std::vector<double> matrix, target;
};
Priors priors_of(const propagation::Experiment& experiment, const std::vector<Unknown>& unknowns);

} // namespace gumshoe::calibration
