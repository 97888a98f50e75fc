#pragma once
/// Fits the periods of waves and the time constants of drifts together with everything else.
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// The fit with the parameters of its waves and drifts at their most likely values: Gauss-Newton steps, each with all
/// else fitted. They were sought before other terms were known. Sets Candidate::parameter_u.
JointFit with_tuned_forms(const TraceContext& context, JointFit fit);

} // namespace gumshoe::tracing
