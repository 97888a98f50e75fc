#pragma once
/// What the operator set for each reading, where the model has a quantity: a holder's angle, an offset, a position.
#include "scenario/context.h"

namespace gumshoe::scenario {

/// Replaces `column` of a quantity by what it stands for: a label of the readings and a column of [trace] of the
/// quantity's name, and by that label one entry per set-point, the cell being its value. What else the quantity states,
/// such as u, is the deviation from the set-point, drawn once per set-point, which `per` divides further. Adds
/// problems: no [data], no such column, no unit, a cell that is no number, a value besides.
void expand_set_points(Node& document, DataFiles& files, Problems& problems);

} // namespace gumshoe::scenario
