#pragma once
/// The scenario that is searched: all that might be missing stands in it at null.
#include "scenario/scenario.h"

namespace gumshoe::tracing {

/// The scenario with every effect of the model's stages in it, those it does not free at null, stated effects too.
/// What `[trace] free` names is estimated and tied to nothing.
scenario::Scenario extended(const scenario::Scenario& scenario);

} // namespace gumshoe::tracing
