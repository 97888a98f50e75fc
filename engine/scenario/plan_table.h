#pragma once
/// The table in which planned readings are written: the columns of the data file, else those of the scenario; and those
/// for what the allowed readings set but the file has no column for.
#include "scenario/plan.h"

namespace gumshoe::scenario {

std::vector<PlanColumn> plan_columns(const PlanScope& scope, const std::vector<AllowedReading>& allowed,
                                     Context& context);

} // namespace gumshoe::scenario
