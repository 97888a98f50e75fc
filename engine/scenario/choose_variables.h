#pragma once
/// [choose.variables]: the settings that may be chosen, each with its values or their range.
#include "scenario/knobs.h"

namespace gumshoe::scenario {

Shape variables_shape();
/// Shape of a setting's value.
Shape setting_shape();

std::vector<Variable> read_variables(Table& table, KnobReader& knobs);

} // namespace gumshoe::scenario
