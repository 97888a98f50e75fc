#pragma once
/// Shapes of unknown form: the search of the best one, and the same with another parameter.
#include <functional>
#include <utility>

#include "tracing/candidates/candidates.h"

namespace gumshoe::tracing {

/// Squares of the residuals that each group of `each` neighbouring columns explains, in units of the noise. Rows in the
/// order of measurement. 0 where the declared model leaves less than a share of the columns.
using Gain = std::function<Vector(const Matrix& columns, Index each, double share)>;
inline constexpr Index at_once = 64; ///< columns of which the gain is sought together, by memory

/// The same wave, drift or lag with another parameter. @param shape  not of Form::fixed
Candidate with_parameter(const Observations& observations, const Candidate& shape, double parameter);
/// Ends between which its parameter is sought; infinite of a wave.
std::pair<double, double> parameter_limits(const Observations& observations, const Candidate& shape);

} // namespace gumshoe::tracing
