#pragma once
/// The scores of one trace.
#include "tracing/campaigns/campaign.h"
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// Scores of every physical candidate, by its tangent, on the training readings. `fit` has no terms; its covariance model
/// weighs the readings. Candidates that the declared model absorbs are left out.
Campaign scores_of(const TraceContext& context, const JointFit& fit);

} // namespace gumshoe::tracing
