#pragma once
/// Poincare constants of distributions of one variable.
#include "quantities/distribution.h"

namespace gumshoe::analysis {

/// The smallest C with var g(X) <= C E[g'(X)^2] for every smooth g, in the square of X's unit; NaN where none is
/// known here or none exists.
///   rectangular (b - a)^2 / pi^2; normal sigma^2; exponential 4 mean^2 (Roustant, Barthe, Iooss 2017, Table 1);
///   others with a density on a bounded interval: 1 / C is the least positive eigenvalue of -(rho g')' = lambda rho g
///   with free ends (ibid., section 4), by finite elements, relative error below 1e-5;
///   t and lognormal: none exists (tails heavier than exponential); gamma: not known here; discrete and empirical:
///   none, there is no density.
double poincare_constant(const quantities::Distribution& distribution);

} // namespace gumshoe::analysis
