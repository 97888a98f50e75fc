#pragma once
/// Fits the periods of waves together with everything else.
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// The fit with the periods of its waves at their most likely values: Gauss-Newton steps of the cycles over the range,
/// each with all else fitted. They were sought before other terms were known. Sets Candidate::cycles_u.
JointFit with_tuned_waves(const TraceContext& context, JointFit fit);

} // namespace gumshoe::tracing
