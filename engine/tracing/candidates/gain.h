#pragma once
/// What a shape of unknown form would explain, for the search of its best form.
#include <functional>

#include "tracing/candidates/candidates.h"

namespace gumshoe::tracing {

/// Squares of the residuals that each group of `each` neighbouring columns explains, in units of the noise. Rows in the
/// order of measurement. 0 where the declared model leaves less than a share of the columns.
using Gain = std::function<Vector(const Matrix& columns, Index each, double share)>;

} // namespace gumshoe::tracing
