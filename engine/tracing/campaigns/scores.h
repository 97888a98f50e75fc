#pragma once
/// The scores of one trace.
#include "tracing/campaigns/campaign.h"
#include "tracing/fit/trace_context.h"

namespace gumshoe::tracing {

/// Of the training readings, of every physical candidate by its tangent, under the covariance model of `fit`, which has
/// no terms. Candidates that the declared model absorbs are left out.
Campaign scores_of(const TraceContext& context, const JointFit& fit);

} // namespace gumshoe::tracing
