#pragma once
/// What the studies beyond summary and budget find, as plain data in SI units. study_fields.cpp says how it is shown.
#include <cstdint>
#include <string>
#include <vector>

#include "propagation/run.h"

namespace gumshoe::analysis {

/// How well an index is known: "resolved", "zero within its interval", "not converged".
using Verdict = std::string;

struct SobolIndex {
  std::string input;
  double first = 0, first_low = 0, first_high = 0;
  double total = 0, total_low = 0, total_high = 0;
  Verdict first_verdict, total_verdict;
};
struct SobolPair {
  std::string a, b;
  double second = 0, low = 0, high = 0; ///< second-order index: of a and b together, beyond each alone
  Verdict verdict;
};
struct Sensitivity {
  propagation::Output output;
  std::uint64_t base_samples = 0, dropped_rows = 0;
  double confidence = 0.95; ///< level of the intervals
  std::vector<SobolIndex> indices;
  std::vector<SobolPair> pairs; ///< empty unless asked for
};

/// An index with its 95 % confidence interval.
struct Index {
  std::string input;
  double value = 0, low = 0, high = 0;
  Verdict verdict;
};
/// Shares of the variance that close to 1 for dependent inputs too (Owen 2014; Song, Nelson, Staum 2016).
struct Shapley {
  propagation::Output output;
  std::uint64_t rows = 0, dropped_rows = 0;
  std::vector<Index> effects;
};
/// From stored samples alone: rank-based first-order index (Chatterjee 2021; Gamboa et al. 2022) and Borgonovo's delta.
struct GivenData {
  propagation::Output output;
  std::uint64_t samples = 0, dropped = 0; ///< used; failed among the first ones
  std::vector<Index> first, delta; ///< the same inputs in the same order
};
/// Screening by elementary effects (Morris 1991; Campolongo 2007): change of the output per standard uncertainty of
/// the input, so in the output's unit (scaling: screening.h).
struct MorrisRow {
  std::string input;
  double mean = 0, mean_absolute = 0, mean_absolute_se = 0, standard_deviation = 0;
};
struct Morris {
  propagation::Output output;
  std::uint64_t trajectories = 0, dropped = 0;
  std::vector<MorrisRow> rows;
};
/// Derivative-based measures (Sobol' and Kucherenko 2009): nu = E[(df/dx)^2], and the bound on the total index
/// that it gives with the Poincare constant of the input's distribution; NaN where none is known.
struct DgsmRow {
  std::string input;
  double nu = 0, nu_se = 0, bound = 0, bound_low = 0, bound_high = 0;
};
struct Dgsm {
  propagation::Output output;
  std::uint64_t points = 0, dropped = 0;
  bool exact = true; ///< false: differences, the model has no derivatives
  std::vector<DgsmRow> rows;
};
/// Each quantity in turn moved by its step, the others at their estimates.
struct OneAtATimeRow {
  std::string quantity, unit, si_unit;
  double step = 0;              ///< SI
  std::vector<double> up, down; ///< change of each output, SI; NaN where it has no value
};
struct OneAtATimeTable {
  std::string title;
  std::vector<propagation::Output> outputs;
  std::vector<OneAtATimeRow> rows;
};

/// Several measurands at once: JCGM 102 clause 7. Matrices are row-major.
struct JointRegion {
  std::vector<propagation::Output> outputs;
  std::vector<double> estimate, covariance, correlation;
  std::vector<double> gum_covariance; ///< C V C', JCGM 102 6.2; empty where the framework does not apply
  double coverage_probability = 0.95;
  double k_p = 0, k_p_se = 0; ///< ellipsoid: (y - estimate)' covariance^-1 (y - estimate) <= k_p^2; NaN if singular
  double k_q = 0, k_q_se = 0; ///< rectangle: |y_i - estimate_i| <= k_q u_i
  std::string remark;         ///< why there is no ellipsoid
};

/// What the least-squares fit of a joint evaluation says of its unknowns by itself, without Monte Carlo. Matrices are
/// row-major, SI.
struct FitCovariance {
  std::vector<propagation::Output> outputs;
  std::vector<double> standard_uncertainty, covariance, correlation; ///< infinite, NaN: undetermined by the readings
  std::uint64_t equations = 0;                                       ///< indications
  double degrees_of_freedom = 0;                                     ///< of the residuals
  /// Standard deviation of an indication by the residuals, by which the covariance is scaled; of a virtual experiment
  /// that of its samples. NaN of a weighted fit, whose scale is declared.
  double scatter = 0;
  double chi_squared = 0, probability = 0; ///< of a weighted fit of readings, and of a larger value; NaN else
  propagation::Output output;              ///< root mean square of the residuals, in the unit of `scatter`
  std::string meaning;                     ///< what the covariance is, in a sentence
};
/// Statistics of an angle on the circle (Mardia and Jupp 2000).
struct CircularSummary {
  propagation::Output output;
  double mean_direction = 0, resultant_length = 0, standard_deviation = 0; ///< sqrt(-2 ln R), rad
  double low = 0, high = 0; ///< shortest arc that holds the coverage probability; high >= low, may pass pi
  std::string remark;       ///< when the linear statistics mislead
  double mean_direction_se = 0, resultant_length_se = 0, standard_deviation_se = 0; ///< Monte Carlo standard errors
};

/// JCGM 106:2012. Risks are probabilities; NaN where they need what is not given.
struct ConformityResult {
  propagation::Output output;
  double lower = 0, upper = 0;                       ///< tolerance limits, SI; NaN: none
  double acceptance_lower = 0, acceptance_upper = 0; ///< with guard bands; NaN: none
  double guard_band = 0;                             ///< w, SI; above 0: guarded acceptance, below: guarded rejection
  std::string rule;                                  ///< decision rule by name
  double estimate = 0, estimate_se = 0;              ///< with its Monte Carlo standard error, NaN where it is unknown
  double conformance_probability = 0, conformance_probability_se = 0; ///< from this measurement alone
  /// What so many samples support: one-sided 95 % confidence limits of p_c.
  double conformance_probability_low = 0, conformance_probability_high = 1;
  double least_risk = 0; ///< risks below are not resolved by the samples
  bool accepted = false;
  double specific_consumer_risk = 0, specific_producer_risk = 0; ///< NaN for the one that the decision excludes
  double process_mean = 0, process_u = 0, process_conformance = 0; ///< NaN without a process
  /// Process and measurement together (clause 7.2.2); NaN without a process, or if they hardly overlap.
  double posterior_conformance = 0, posterior_conformance_se = 0;
  double global_consumer_risk = 0, global_consumer_risk_se = 0; ///< NaN without a process
  double global_producer_risk = 0, global_producer_risk_se = 0; ///< NaN without a process
  std::string statement;                                        ///< the numbers with their definitions

  /// "accepted" or "rejected"; and that chance decided, where the estimate is as near to an acceptance limit as other
  /// samples would move it: within twice its Monte Carlo standard error.
  std::string decision() const;
};

/// Which standard uncertainties would give the wanted expanded uncertainty?
struct TargetRow {
  std::string quantity, unit, si_unit;
  double present = 0;   ///< standard uncertainty now, SI
  double allowed = 0;   ///< largest, the others as they are; NaN: none reaches the target; infinite: it does not matter
  double allowed_gum = 0; ///< the same by the law of propagation
  double cost = 0;      ///< relative; NaN: not given
  double cheapest = 0;  ///< in the cheapest combination; NaN: no cost given, or none exists
};
struct TargetResult {
  propagation::Output output;
  double wanted = 0, present = 0, reached = 0; ///< expanded uncertainties; reached: with the cheapest combination, NaN if none
  double cost_ratio = 0;                       ///< cost of the cheapest combination over the present one
  std::vector<TargetRow> rows;
  std::string statement;
};

/// How an adaptive run came to its number of samples (JCGM 101 7.9; Wuebbeler et al. 2010).
struct StoppingRecord {
  std::string rule;               ///< "jcgm_101" or "stein"; empty: the number was given
  int digits = 2;
  std::uint64_t block = 0;        ///< trials per block
  std::uint64_t jcgm_trials = 0, stein_trials = 0; ///< by either rule; 0: not reached
  std::uint64_t trials = 0;       ///< used
  bool reached = true;            ///< false: gave up at max_samples
  std::vector<double> tolerance;  ///< delta of each output, SI
  std::string statement;
};

} // namespace gumshoe::analysis
