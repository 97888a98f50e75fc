#pragma once
/// Two results of the same measurands, such as before and after a change of the machine: do they agree, and what made
/// the uncertainty larger or smaller?
#include <string>
#include <vector>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Standard uncertainty that a quantity contributes to the two results, SI of the measurand.
struct ContributionChange {
  std::string quantity;
  double before = 0, after = 0;
};

struct Agreement {
  Summary before, after; ///< estimate, u, U, k and certificate; `after` in the unit of `before`
  /// after - before, its u, U and E_n = d / U(d); NaN where a result has no uncertainty, or none that differs from 0.
  ComparisonResult difference;
  std::vector<ContributionChange> changes; ///< by the change of the contribution squared, largest first
  std::vector<std::string> counted;        ///< components treated as the same in both results
  /// Quantities that both budgets list alike (Type B, equal u and distribution), treated as independent although
  /// counting them would change u(d) by more than 1 %.
  std::vector<std::string> alike;
};

struct Agreements {
  std::vector<Agreement> rows;                      ///< of the measurands that both results have, by name
  std::vector<std::string> only_before, only_after; ///< names of the others
};

/// Compares the measurands of the same name.
///
/// The results are taken as independent, except for the quantities `same`, which have one unknown error in both (the
/// same certificate, the same reference): component by component their covariance is
///     cov = sum c_before u_before c_after u_after    (JCGM 100, F.1.2.3),
/// u(d)^2 = u_before^2 + u_after^2 - 2 cov and U(d)^2 = U_before^2 + U_after^2 - 2 k_before k_after cov. This is the
/// first order; correlations between different quantities are not counted.
///
/// @param before, after what store::read_results() gives
/// @param same          quantities, by name
/// Throws InputError: no common measurand, different coverage probabilities or dimensions, a quantity of `same` that
/// both budgets do not have, or has no sensitivity coefficient.
Agreements agreements(const Results& before, const Results& after, const std::vector<std::string>& same);

} // namespace gumshoe::analysis
