#pragma once
/// The numerical tolerance of a standard uncertainty: JCGM 101 7.9.2.
#include "propagation/run.h"

namespace gumshoe::analysis {

/// u = c 10^l with c an integer of `digits` digits: delta = 10^l / 2. The power of ten is of the unit that people
/// read, the result is in SI. u must be positive.
double numerical_tolerance(double u, int digits, const propagation::Output& output);

} // namespace gumshoe::analysis
