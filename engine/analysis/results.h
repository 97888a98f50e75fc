#pragma once
/// Everything a finished run says, as plain data in SI units: what the file holds and the report shows.
#include <cstdint>
#include <string>
#include <vector>

#include "propagation/run.h"
#include "quantities/input_quantity.h"

namespace gumshoe::analysis {

struct Interval {
  double low = 0, high = 0;
  double low_se = 0, high_se = 0;     ///< Monte Carlo standard errors of the ends
  double low_rank = 0, high_rank = 0; ///< ends that hold whatever values the failed samples had
};

struct Summary {
  propagation::Output output;
  std::uint64_t valid = 0, failed = 0;
  double estimate = 0, estimate_se = 0;
  double standard_uncertainty = 0, standard_uncertainty_se = 0; ///< NaN if none exists; see `warning`
  double skewness = 0, kurtosis = 0;
  Interval symmetric;            ///< probabilistically symmetric coverage interval, JCGM 101 5.3.3
  Interval shortest;             ///< shortest coverage interval, JCGM 101 5.3.4
  double shortest_length_se = 0; ///< of its length, which is known better than its ends
  std::vector<double> bin_edges; ///< histogram: n + 1 edges,
  std::vector<double> density;   ///< n densities, 1/unit
  double hill_index = 0; ///< tail index by Hill's estimator; small: heavy tails, below 2 no variance; NaN: not estimated
  std::string warning;           ///< "no standard uncertainty: ..." or empty
  std::string tail_remark; ///< heavy tails though a standard uncertainty exists: what its standard error is worth; or empty
  std::string statement;   ///< the result in the words of the GUM (7.2)
};

/// One row of an uncertainty budget: one component of one input quantity that reaches the output.
struct Contribution {
  std::string name;     ///< "beam_pitch[setup 1]", with ": component" where there are several
  std::string quantity; ///< "beam_pitch"
  std::string unit, si_unit;
  double estimate = 0;
  double standard_uncertainty = 0; ///< NaN: infinite variance
  char evaluation = 'B';
  std::string distribution;
  double degrees_of_freedom = 0; ///< 0: infinite
  bool differentiable = true;
  double sensitivity = 0;       ///< c_i, SI; NaN if not differentiable here
  double contribution = 0;      ///< |c_i| u_i, SI
  double share = 0;             ///< (c_i u_i)^2 / u_c^2
  double monte_carlo_share = 0; ///< first-order Sobol' index; NaN if not computed
  std::string scope;            ///< "per setup", "" for the whole run
  std::string source;
};

/// The GUM framework for one output: JCGM 100 clause 5, Annex G.
struct Budget {
  propagation::Output output;
  bool applicable = true;
  std::string reason;  ///< why the framework does not apply
  double estimate = 0; ///< model at the estimates
  std::vector<Contribution> contributions;
  double correlation_share = 0;             ///< the one correlation row, adding up to 1 with the shares
  double monte_carlo_interactions = 0;      ///< 1 - sum of first-order indices; NaN if not computed
  double combined_standard_uncertainty = 0; ///< u_c, first order
  double second_order_uncertainty = 0;      ///< u_c with the terms of 5.1.2 note
  double second_order_bias = 0;             ///< half the sum of H_ii u_i^2: mean minus estimate
  double effective_degrees_of_freedom = 0;  ///< truncated (G.4.1); 0: infinite; NaN: inputs correlated
  double coverage_factor = 0;
  double expanded_uncertainty = 0;
  std::string remark; ///< why no effective degrees of freedom are stated; empty if they are, or all are infinite
};

/// JCGM 101 clause 8.
struct Validation {
  propagation::Output output;
  double delta = 0, d_low = 0, d_high = 0;
  double monte_carlo_tolerance = 0; ///< must be below delta / 5
  int digits = 2;
  std::string verdict; ///< "validated", "not validated", "undecided", "not applicable"
  std::string reason;
};

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
  double confidence = 0.95; ///< of the intervals
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
/// Of an angle: statistics on the circle (Mardia and Jupp 2000).
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
  double estimate = 0;
  double conformance_probability = 0, conformance_probability_se = 0; ///< from this measurement alone
  bool accepted = false;
  double specific_consumer_risk = 0, specific_producer_risk = 0; ///< NaN for the one that the decision excludes
  double process_mean = 0, process_u = 0, process_conformance = 0; ///< NaN without a process
  /// Process and measurement together (clause 7.2.2); NaN without a process, or if they hardly overlap.
  double posterior_conformance = 0, posterior_conformance_se = 0;
  double global_consumer_risk = 0, global_consumer_risk_se = 0; ///< NaN without a process
  double global_producer_risk = 0, global_producer_risk_se = 0; ///< NaN without a process
  std::string statement;                                        ///< the numbers with their definitions
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

/// d = a - b from joint samples; E_n = d / U(d), U(d) half the shortest coverage interval.
struct ComparisonResult {
  std::string name, a, b; ///< "laser_z: rod 1 - rod 2, setup 1"
  std::string unit, si_unit;
  double difference = 0, standard_uncertainty = 0;
  double root_sum_square = 0; ///< what ignoring the common inputs would give
  double expanded_uncertainty = 0, normalised_error = 0;
};

struct PrintedResult {
  std::string output, source, unit, si_unit;
  double printed = 0, ours = 0, expanded_uncertainty = 0;
};

/// A quantity as the scenario knows it, for the record.
struct InputRecord {
  std::string name, unit, si_unit, labels, distribution, evaluation, scope, source;
  double value = 0, standard_uncertainty = 0;
};

struct Results {
  std::string title, model, model_title, method, evaluation, scenario_file, scenario_text, scenario_hash;
  std::string version, git_hash, instruction_set, design;
  std::uint64_t seed = 0, samples = 0, failed = 0;
  double coverage_probability = 0.95;
  std::vector<std::string> failures;   ///< "never_covered: 12 samples, first 345"
  std::vector<std::string> notes;
  std::vector<quantities::Reading> readings;
  std::vector<std::string> condition_names, condition_units, indication_names, indication_units; ///< SI units
  std::vector<InputRecord> inputs;
  std::vector<Summary> summaries;
  std::vector<Budget> budgets;
  std::vector<Validation> validations;
  std::vector<Sensitivity> sensitivities;
  std::vector<ComparisonResult> comparisons;
  std::vector<PrintedResult> printed;
  std::vector<Shapley> shapley;
  std::vector<GivenData> given_data;
  std::vector<Morris> morris;
  std::vector<Dgsm> dgsm;
  std::vector<OneAtATimeTable> one_at_a_time;
  std::vector<JointRegion> joint;
  std::vector<CircularSummary> circular;
  std::vector<ConformityResult> conformity;
  std::vector<TargetResult> targets;
  StoppingRecord stopping;
};

} // namespace gumshoe::analysis
