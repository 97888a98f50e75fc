#pragma once
/// The scenario with further readings after its own.
#include "scenario/plan_options.h"
#include "scenario/scenario.h"

namespace gumshoe::tracing {

/// True if the scenario has readings already, and not just the conditions of some.
bool has_readings(const scenario::Scenario& scenario);

/// The scenario with so many of each allowed reading, after its own (which are left out if they hold nothing). A new
/// value of a label has the declared quantities of the value that the first reading has. Nothing is read there: zeros.
/// Readings in one order: as measured, the further ones last.
scenario::Scenario with_readings(const scenario::Scenario& scenario, const std::vector<int>& count);

/// New values of labels that an allowed reading needs: "setup 4". Labels that only name a condition open nothing.
std::vector<std::pair<std::string, std::string>> new_values(const scenario::Scenario& scenario,
                                                            const scenario::AllowedReading& reading);

} // namespace gumshoe::tracing
