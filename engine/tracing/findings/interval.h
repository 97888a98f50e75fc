#pragma once
/// An interval for a size that was reported only because it was large enough.
#include <utility>

namespace gumshoe::tracing {

/// 95 % interval of a normal mean from one observation x with standard uncertainty u, given |x| > least: both ends
/// solve for the mean under which the truncated distribution has x at its 2.5 % and 97.5 % quantile. With least = 0 it
/// is x +- 1.96 u. Far above `least` it tends to the same. Lee, Sun, Sun and Taylor, Annals of Statistics 44 (2016)
/// 907, for one statistic and a fixed threshold. The near end lies no further than `least` from x: the test that x
/// passed holds for all sizes tried together, and an interval that goes along with it excludes zero. An x that is not
/// beyond `least`, because the whole model gave another size than the linearised one that passed, has the plain
/// interval, widened to what barely passing allows.
std::pair<double, double> interval_after_selection(double x, double u, double least);

} // namespace gumshoe::tracing
