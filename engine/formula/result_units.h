#pragma once
/// Units in which results of formulas are shown.
#include "formula/compile.h"
#include "formula/dimensions.h"

namespace gumshoe::formula {

/// Fills Compiled::explained and the units of indications that have none. Problems: a stated unit, readings or a true
/// value that the formula's dimension does not fit; a measurand whose dimension no unit has.
/// @param kinds of Compiled::formulas
void settle_units(Compiled& compiled, const std::vector<Kind>& kinds, std::vector<Problem>& problems);

} // namespace gumshoe::formula
