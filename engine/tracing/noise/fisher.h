#pragma once
/// The F test of two mean squares.

namespace gumshoe::tracing {

/// Probability that a ratio of mean squares of so many degrees of freedom is larger than this if both have one variance.
double p_of_f(double ratio, double above, double below);

} // namespace gumshoe::tracing
