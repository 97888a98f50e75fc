#pragma once
/// Any single figure of an estimate by its name, for comparison with published ones (analysis/figures.h).
#include "analysis/figures.h"
#include "calibration/estimate.h"

namespace gumshoe::calibration {

/// Names, `x` and `y` standing for estimated quantities: fit.value[x], fit.standard_uncertainty[x],
/// fit.correlation[x, y], fit.residual_standard_deviation, fit.residual_sum_of_squares, fit.degrees_of_freedom,
/// fit.converged ("yes" or "no"). Throws InputError for a name that is none of them.
analysis::Figure figure(const Estimate& estimate, const propagation::Experiment& experiment, const std::string& name);

} // namespace gumshoe::calibration
