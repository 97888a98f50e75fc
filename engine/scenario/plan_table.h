#pragma once
/// The table in which planned readings are written: the columns of the data file, else those of the scenario.
#include "scenario/plan.h"

namespace gumshoe::scenario {

std::vector<PlanColumn> plan_columns(const PlanScope& scope, Context& context);

} // namespace gumshoe::scenario
