#pragma once
/// The fields of a plan, for programs (analysis/fields.h).
#include "analysis/fields.h"
#include "tracing/planning/planning.h"

namespace gumshoe::tracing {

extern const analysis::Fields<Planned> plan_fields;
extern const analysis::Fields<PlannedReading> planned_reading_fields;
extern const analysis::Fields<GoalReached> goal_fields;
extern const analysis::Fields<Verified> verified_fields;

} // namespace gumshoe::tracing
