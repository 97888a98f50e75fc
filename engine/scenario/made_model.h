#pragma once
/// Models that a scenario describes: [model] name = "expression", "plugin", "command" or "sphere_probing".
#include "models/model.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

/// The names, for messages and for the parser's choice.
inline constexpr const char* made_models[] = {"expression", "plugin", "command", "sphere_probing"};

/// Each reads its own keys of [model]; null and problems if something is wrong. `folder`: the scenario's, where
/// files it names are looked for.
models::MadeModel make_expression(Table& model, Table& top, Context& context);
models::MadeModel make_plugin(Table& model, const std::string& folder, Context& context);
models::MadeModel make_command(Table& model, Table& top, const std::string& folder, Context& context);
/// Its machine is the section [machine].
models::MadeModel make_sphere_probing(Table& top, Context& context);

} // namespace gumshoe::scenario
