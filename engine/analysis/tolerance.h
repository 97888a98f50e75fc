#pragma once
/// The numerical tolerance of a standard uncertainty: JCGM 101 7.9.2.
#include "propagation/run.h"

namespace gumshoe::analysis {

/// The tolerance delta = 10^l / 2, where u = c 10^l with an integer c of `digits` digits. The power of ten refers to the
/// unit shown to people; the result is in SI. Infinite if u is zero, infinite or NaN, which have no digits.
double numerical_tolerance(double u, int digits, const propagation::Output& output);

} // namespace gumshoe::analysis
