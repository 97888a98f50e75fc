#pragma once
/// Models from shared libraries; the interface they implement is gumshoe_plugin.h.
#include <string>

#include "base/error.h"
#include "models/model.h"

namespace gumshoe::models {

/// Loads the library and checks its card. `name`: as the scenario calls it; `where`: the place there. Throws
/// InputError: no such file, no library, no such function, another version, a card that contradicts itself.
MadeModel load_plugin(const std::string& path, const std::string& name, const Location& where);

} // namespace gumshoe::models
