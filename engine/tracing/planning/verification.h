#pragma once
/// Tries `gumshoe trace` on simulated readings: those there are, and those planned.
#include "tracing/planning/linear_model.h"
#include "tracing/planning/planning.h"

namespace gumshoe::tracing {

/// Of `settings.verify` data sets that each hold an effect of the goals in its assumed size, the share in which a trace
/// names it, and of a split not the other one. No block is held out, so that all readings are searched.
/// @param count  by usable allowed reading
std::vector<Verified> verify(const scenario::Scenario& scenario, const LinearModel& model,
                             const std::vector<int>& count, const std::vector<GoalReached>& goals,
                             const PlanSettings& settings);

} // namespace gumshoe::tracing
