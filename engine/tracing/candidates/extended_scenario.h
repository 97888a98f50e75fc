#pragma once
/// The scenario that is searched: it contains every candidate effect, at null.
#include "scenario/scenario.h"

namespace gumshoe::tracing {

/// The scenario with every effect of the model's stages and every stated effect; those that it does not free are at
/// null. The quantities named by `[trace] free` are estimated and uncorrelated.
scenario::Scenario extended(const scenario::Scenario& scenario);

} // namespace gumshoe::tracing
