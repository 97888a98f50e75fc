#pragma once
/// Derivatives by differences, for models that have none of their own (a plugin, a command).
#include "analysis/derivatives.h"

namespace gumshoe::analysis {

/// Central differences over one and half a standard uncertainty, extrapolated to a step of zero (Richardson), by
/// every quantity that varies at this reading; NaN by the others. All points in one call. At a kink, where the slopes
/// on either side do not come together, not differentiable. `second`: Hessian and the third derivatives of JCGM 100
/// 5.1.2 note as well, exact for cubic models.
/// @return by measurand
std::vector<Derivatives> differences(const propagation::Experiment& experiment, std::size_t reading,
                                     const std::vector<double>& point, bool second);

} // namespace gumshoe::analysis
