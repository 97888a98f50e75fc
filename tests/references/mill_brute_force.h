#pragma once
/// A twin of the mill's trigger that shares no formula with the engine: the insert is a stack of discs, its shadow's
/// edges in a column are found by a search over the stack, the covered area is a sum over columns.
#include <vector>

#include "laws/mill_rows.h"

namespace gumshoe::tests {

/// Area of the beam's disc covered by one insert at spindle angle psi, the tool's centre at height h. Sum over
/// `columns` strips; its error falls with the square of their number.
double covered_by_strips(const double* q, double psi, double h, int columns);

} // namespace gumshoe::tests
