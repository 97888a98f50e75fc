#pragma once
/// Estimated sizes with which readings jump: no tangent leads to them.
#include <optional>

#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

/// The scenario with its estimated sizes of one value, with which readings jump, where a search explains the readings
/// best, and named in `[trace] jumping`, from where the fit goes on. None if there are no such sizes, but for those
/// that an earlier trace of the readings found. @param experiment  experiment of the extended scenario, as of `fitter`
std::optional<scenario::Scenario> with_jumping_found(const scenario::Scenario& scenario,
                                                     const propagation::Experiment& experiment,
                                                     const Simulator& simulator, const Observations& observations,
                                                     const Fitter& fitter, int threads);

/// Whether an earlier trace of these readings fitted the quantity: this one starts where that ended.
bool fitted_before(const scenario::TraceOptions& trace, const std::string& name);

} // namespace gumshoe::tracing
