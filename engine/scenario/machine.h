#pragma once
/// [machine]: a named machine, or the axes of one's own.
#include <optional>

#include "chain/machine.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

Shape machine_shape();

/// nullopt and problems, each at its place, if the section is missing or wrong.
///     name = "TTTRR"                                       # a predefined machine, or any name if both sides are given
///     workpiece_side = ["Y", { axis = "C", point = ["0 mm", "0 mm", "-50 mm"], sense = 1 }]   # from the bed outwards
///     tool_side = ["X", { axis = "B", direction = [0, 1, 1] }, { axis = "J6", dh = { d = "80 mm", alpha = "90 deg" } }]
///     points = { C = ["0 mm", "0 mm", "-50 mm"] }          # of a predefined machine
///     errors = { E_A0C = "0.01 deg" }                      # defaults of the quantities of these names
std::optional<chain::MachineDescription> read_machine(Table& top, Problems& problems);

} // namespace gumshoe::scenario
