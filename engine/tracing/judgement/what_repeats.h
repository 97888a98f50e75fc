#pragma once
/// What comes back among the training readings: equal conditions, blocks, and rounding to a coarse display's steps.
#include "tracing/fit/trace_context.h"
#include "tracing/judgement/assess.h"

namespace gumshoe::tracing {

/// Readings of equal conditions and of blocks among the training readings. Keeps a reference to the fit's design.
Repeats repeats_of(const TraceContext& context, const JointFit& fit);

} // namespace gumshoe::tracing
