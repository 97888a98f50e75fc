#pragma once
/// Power of a test of amplitudes whose true non-centrality is known.
namespace gumshoe::tracing {

/// Probability that the statistic exceeds its 1 - alpha quantile: chi-squared with k degrees of freedom, or F with k
/// and `freedom` where the noise is estimated: those of the residuals of the fit that has the k amplitudes in it.
/// @param freedom  infinity: the noise is known; below 1: there is no test, and the power is alpha
double power(double noncentrality, int k, double freedom, double alpha);
/// The non-centrality that gives this power; 1e16 where none does.
double noncentrality_for(double power, int k, double freedom, double alpha);

} // namespace gumshoe::tracing
