#pragma once
/// Tries `gumshoe trace` on simulated readings: those there are, and those planned.
#include "tracing/planning/linear_model.h"
#include "tracing/planning/planning.h"

namespace gumshoe::tracing {

/// Share of `settings.verify` simulated data sets in which a trace names the effect that they hold in its assumed size,
/// and, for a split, does not name the other one. No block is held out, so that all readings are searched.
/// @param count  by usable allowed reading
std::vector<Verified> verify(const scenario::Scenario& scenario, const LinearModel& model,
                             const std::vector<int>& count, const std::vector<GoalReached>& goals,
                             const PlanSettings& settings);

} // namespace gumshoe::tracing
