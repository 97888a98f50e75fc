#pragma once
/// Where the search starts if its own steps from the stated values do not arrive.
#include <optional>

#include "scenario/scenario.h"

namespace gumshoe::tracing {

/// The scenario with its free quantities at their least-squares estimates: values that are no prior and only say where
/// to start. Empty if there are none, or if the estimates do not converge either.
std::optional<scenario::Scenario> at_estimates(const scenario::Scenario& scenario, int threads);

} // namespace gumshoe::tracing
