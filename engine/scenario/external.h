#pragma once
/// Code outside of this program that a scenario names: a command's program, a plugin's library. It runs with the user's
/// rights, so it is looked at before it is loaded.
#include <string>

#include "scenario/context.h"

namespace gumshoe::scenario {

/// Notes the code, whose files have been included in the context. False, and a problem at the node, if it may not be
/// started. `key`: "model.command"; `code`: "python3 model.py".
bool admit(Context& context, const Node& node, const std::string& key, const std::string& code);

} // namespace gumshoe::scenario
