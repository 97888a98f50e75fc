#pragma once
/// Derivatives by differences, for models that have none of their own (a plugin, a command).
#include "analysis/derivatives.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Step by each quantity, SI: one standard uncertainty, rounded down to a power of two and short of the quantity's
/// limits; 0 where it does not vary at this reading.
std::vector<double> steps(const propagation::Experiment& experiment, std::size_t reading,
                          const std::vector<double>& point);
/// Bound on the rounding error of a value, in its unit.
double rounding(double value);
/// Whether the slopes on either side of a value differ by a kink: on a smooth branch their difference halves with the
/// step, at a kink it stays. @param up, half_up  values at the step and at half of it
bool is_kink(double up, double down, double half_up, double half_down, double value);

/// Central differences over one and half a standard uncertainty, extrapolated to a step of zero (Richardson), by
/// every quantity that varies at this reading; NaN by the others. All points in one call. At a kink, where the slopes
/// on either side do not come together, not differentiable. `second`: Hessian and the third derivatives of JCGM 100
/// 5.1.2 note as well, exact for cubic models.
/// @return by measurand
std::vector<Derivatives> differences(const propagation::Experiment& experiment, std::size_t reading,
                                     const std::vector<double>& point, bool second);

/// True if the derivatives at the estimates are differences: the budgets take stencils of model runs.
bool stencils_at_estimates(const propagation::Experiment& experiment);
/// The runs of the stencil at the estimates of a reading (Output::reading), with the points of second derivatives if a
/// budget needs them. A unit is one point.
propagation::Work stencil_work(const propagation::Experiment& experiment, std::size_t reading);
/// What they give. The stencil of first derivatives comes first.
propagation::Responses stencil_values(const propagation::Experiment& experiment, std::size_t reading,
                                      const propagation::Workers& workers);
/// The same as differences() at the estimates, from these values. Where they have no points of second derivatives, the
/// model runs.
std::vector<Derivatives> differences_from(const propagation::Responses& values,
                                          const propagation::Experiment& experiment, std::size_t reading, bool second);

} // namespace gumshoe::analysis
