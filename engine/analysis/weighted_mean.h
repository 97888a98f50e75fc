#pragma once
/// Several results of the same measurands, combined by least squares: the weighted mean and whether the results are
/// consistent with it.
#include <string>
#include <vector>

#include "analysis/results.h"
#include "base/error.h"

namespace gumshoe::analysis {

/// Results whose chi-squared would be exceeded with a smaller probability than this are inconsistent (Cox 2002,
/// procedure A).
inline constexpr double least_consistent_probability = 0.05;

/// A result that is to be combined.
struct NamedResult {
  std::string name; ///< its file
  Results results;  ///< what store::read_results() gives
};

/// What one result is in the mean of a measurand.
struct WeightedPart {
  std::size_t result = 0; ///< position among the results given
  Summary summary;        ///< in that result: estimate, u and degrees of freedom as combined; unit of the mean
  double own = 0;         ///< standard uncertainty without what is shared
  double own_degrees_of_freedom = 0;
  double weight = 0;           ///< negative where a strong correlation makes it so; they add up to 1
  double difference = 0;       ///< from the mean
  double normalised_error = 0; ///< E_n = d / U(d); NaN where U(d) is 0
};

/// A component that has one unknown error in several results.
struct SharedPart {
  std::string name, quantity; ///< "rod_length[rod 1]" and "rod_length"
  double degrees_of_freedom = 0;
  std::vector<double> contributions; ///< by part, c_i u_i with its sign; 0 where it is not in that budget
};

struct WeightedMean {
  Summary mean; ///< estimate, u, U, k, degrees of freedom and certificate
  std::vector<WeightedPart> parts;
  std::vector<SharedPart> shared;
  double chi_squared = 0; ///< with parts.size() - 1 degrees of freedom if the u were known
  double ratio = 0;       ///< Welch's F: chi^2 over its degrees of freedom, less what estimated u add to it
  double ratio_degrees_of_freedom = 0; ///< of its denominator; infinite where the u are known
  double probability = 0;              ///< of a larger ratio
  double weighing = 0; ///< part of u of the mean: the weights come from estimated u; with these degrees of freedom
  double weighing_degrees_of_freedom = 0;
  /// Quantities that two budgets list alike, taken as independent although counting them would change u^2 of the mean
  /// by more than 1 %.
  std::vector<std::string> alike;
  bool consistent() const { return probability >= least_consistent_probability; }
};

/// A measurand that two or more results have but that cannot be combined.
struct LeftOut {
  std::string output; ///< its name
  Problem problem;    ///< why
};

struct WeightedMeans {
  std::vector<WeightedMean> rows;  ///< of the measurands that two or more results have, by name
  std::vector<LeftOut> left_out;   ///< the others that two or more results have
  std::vector<std::string> single; ///< "z (a.h5)": of one result alone
};

/// Combines the measurands of the same name, or `measurand` alone if it is not empty.
///
/// The results are taken as independent, except for the components of the quantities `same`, which have one unknown
/// error in all of them. With s_ki the contribution c u of such a component k to result i, and v_i what else there is,
///     V = diag(v_i^2) + sum_k s_k s_k',   V_ii = u_i^2,
/// the mean is sum w_i y_i with w = V^-1 1 / (1'V^-1 1), and u^2 = 1 / (1'V^-1 1) (JCGM 102, 7; Cox 2002, Metrologia
/// 39, 589, extended to correlated results). U is that of the t distribution with the effective degrees of freedom of
/// v_i and s_k (JCGM 100, G.4.1). chi^2 = (y - mean)'V^-1 (y - mean); u(y_i - mean)^2 = u_i^2 - u^2.
///
/// Estimated u with nu_i degrees of freedom make the weights p_i uncertain. u^2 is therefore larger by
/// 4 sum p_i (1 - p_i) / nu_i of itself (Meier 1953, Biometrics 9, 59), with nu_i - 2, at least 1, in place of nu_i: of
/// two to ten results with 2 to 10 degrees of freedom U covers 93 % to 96 %, in place of 78 % to 90 %. Whether they are
/// consistent is asked by F with Welch's denominator (Welch 1951, Biometrika 38, 330), which is chi^2 for known u.
///
/// The u_i are the u_c of the budgets with their degrees of freedom where every budget accounts for the variance of its
/// samples (accounts_for_variance()); else all are those of the samples, which have the degrees of freedom in them
/// already. Neither depends on the number of samples. A budget is the first order: its contributions
/// are scaled to add up to u_i, if it accounts for it. Correlations between different quantities of a result are so
/// spread over all of them.
///
/// A measurand cannot be combined if its results have different dimensions, a quantity of `same` has no coefficient, a
/// result has no u, or results differ by nothing but what they share. It is left out if another one can be combined.
///
/// Throws InputError: fewer than two results, no common measurand, no two results with `measurand`, different coverage
/// probabilities, a quantity of `same` that no two budgets have, no measurand that can be combined.
WeightedMeans weighted_means(const std::vector<NamedResult>& results, const std::vector<std::string>& same,
                             const std::string& measurand);

} // namespace gumshoe::analysis
