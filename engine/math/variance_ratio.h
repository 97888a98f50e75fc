#pragma once
/// The F test of two variances.

namespace gumshoe {

/// Probability that a ratio of mean squares of normal values is larger than this if both have one variance.
/// @param above, below  degrees of freedom of numerator and denominator; `below` may be infinite: then chi-squared
double p_of_variance_ratio(double ratio, double above, double below);

} // namespace gumshoe
