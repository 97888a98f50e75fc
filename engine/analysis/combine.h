#pragma once
/// The law of propagation of uncertainty, from contributions to U: JCGM 100, 5.1.2, 5.2.2 and Annex G.
#include <algorithm>
#include <limits>
#include <span>

#include "quantities/correlations.h"

namespace gumshoe::analysis {

/// What one variate adds to the output: c_i u_i with its sign, and the degrees of freedom of u_i.
struct Term {
  std::size_t variate = 0;
  double contribution = 0;
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

struct CombinedVariance {
  double independent = 0; ///< sum of (c_i u_i)^2
  double correlation = 0; ///< what the coefficients add to it
  double effective_degrees_of_freedom = std::numeric_limits<double>::infinity(); ///< NaN if `unequal`
  bool unequal = false; ///< correlated inputs have different degrees of freedom, or those of sums: G.4.1 does not hold
  double total() const { return std::max(0.0, independent + correlation); }
};

/// u_c^2 with effective degrees of freedom. The Welch-Satterthwaite formula holds for independent u_i (G.4.1): inputs
/// whose u are multiples of one estimate are one term, and so are correlated inputs: of a multivariate t distribution
/// with its degrees of freedom, exactly; otherwise with theirs if these are equal, as of inputs from one evaluation;
/// results of earlier runs only if they are one error, with a coefficient of 1 or -1. A variate may stand
/// in several terms, which then add linearly.
CombinedVariance combine(std::span<const Term> terms, quantities::Correlations& correlations);

struct Expansion {
  double effective_degrees_of_freedom = 0; ///< truncated; infinite from 1e6
  double coverage_factor = 0, expanded_uncertainty = 0;
};

/// From u_c^2 to U: the t quantile of the truncated effective degrees of freedom, the normal one without any.
Expansion expand(const CombinedVariance& combined, double coverage_probability);

} // namespace gumshoe::analysis
