#pragma once
/// The law of propagation of uncertainty, from contributions to U: JCGM 100, 5.1.2, 5.2.2 and Annex G.
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "quantities/sample_plan.h"

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
  bool unequal = false; ///< correlated inputs have different degrees of freedom: G.4.1 does not hold
  double total() const { return std::max(0.0, independent + correlation); }
};

/// Pearson's coefficients of a plan's variates, each computed when it is first asked for. For one thread.
class Correlations {
public:
  explicit Correlations(const quantities::SamplePlan& plan);

  /// Correlation coefficient of two variates; 0 if nothing ties them. For a multivariate t it is that of the scales.
  double between(std::size_t a, std::size_t b);

  /// u_c^2 with effective degrees of freedom. Correlated inputs are one term of the Welch-Satterthwaite formula: of a
  /// multivariate t distribution with its degrees of freedom, exactly; otherwise with theirs if these are equal, as of
  /// inputs from one evaluation. A variate may stand in several terms, which then add linearly.
  CombinedVariance combine(std::span<const Term> terms);

private:
  struct Place {
    std::size_t group, member;
  };
  double coefficient(std::size_t group, std::size_t i, std::size_t j);

  const quantities::SamplePlan& plan_;
  std::vector<Place> places_;                     ///< by variate; group: their number, if it is in none
  std::vector<std::vector<double>> coefficients_; ///< by group, n x n; NaN: not computed
};

struct Expansion {
  double effective_degrees_of_freedom = 0; ///< truncated; infinite from 1e6
  double coverage_factor = 0, expanded_uncertainty = 0;
};

/// From u_c^2 to U: the t quantile of the truncated effective degrees of freedom, the normal one without any.
Expansion expand(const CombinedVariance& combined, double coverage_probability);

} // namespace gumshoe::analysis
