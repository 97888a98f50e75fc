#pragma once
/// Everything a finished run says, as plain data in SI units: what the file holds and the report shows.
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/study_results.h"
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
  double estimate = 0, estimate_se = 0; ///< the expectation, or the median where none exists
  bool estimate_is_median = false;
  double standard_uncertainty = 0, standard_uncertainty_se = 0; ///< NaN if none exists; see `warning`
  double skewness = 0, kurtosis = 0;
  /// U and k of the certificate: the GUM framework's where Monte Carlo validates it, else those of the samples.
  /// `monte_carlo_expanded` is the half-width about the estimate that covers the coverage probability. NaN: none.
  double expanded_uncertainty = 0, coverage_factor = 0, monte_carlo_expanded = 0;
  double degrees_of_freedom = 0; ///< effective, of that k; infinite also where k is that of the samples
  std::string certificate;       ///< "laser_z = (10.003387 +- 0.000099) mm, k = 1.96, 95 %"; empty without u
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
  double standard_uncertainty = 0; ///< of a t its scale, Distribution::standard_uncertainty()
  char evaluation = 'B';
  std::string distribution;
  double degrees_of_freedom = 0; ///< may be infinite
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
  double effective_degrees_of_freedom = 0;  ///< truncated (G.4.1); may be infinite; NaN: see remark
  double coverage_factor = 0;
  double expanded_uncertainty = 0;
  std::string remark; ///< why no effective degrees of freedom or, of many inputs, no terms of second order are stated
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

/// d = a - b from joint samples; E_n = d / U(d), U(d) half the coverage interval about d, as in
/// Summary::monte_carlo_expanded.
struct ComparisonResult {
  std::string name; ///< "laser_z: rod 1 - rod 2, setup 1"
  std::string a, b; ///< names of the outputs: "laser_z[rod 1, setup 1]"
  std::string unit, si_unit;
  double difference = 0, standard_uncertainty = 0;
  double root_sum_square = 0; ///< what ignoring the common inputs would give
  double expanded_uncertainty = 0, normalised_error = 0;
};

struct PrintedResult {
  std::string output, source, unit, si_unit;
  double printed = 0, ours = 0, expanded_uncertainty = 0;
};

/// A reading next to its prediction, which was made without it. SI.
struct PredictedReading {
  std::string output, unit, si_unit;
  double read = 0, predicted = 0, low = 0, high = 0; ///< the ends are those of the shortest coverage interval
  bool inside = false;
};

/// A quantity as the scenario knows it, for the record.
struct InputRecord {
  std::string name, unit, si_unit, labels, distribution, evaluation, scope, source;
  double value = 0, standard_uncertainty = 0;
};

/// Deviations drawn for the inputs, by component. They are made again while they are written.
struct InputDraws {
  std::vector<std::string> names, units, si_units;
  /// Samples [first, first + count) of every component, SI: values[component * count + i].
  std::function<void(std::uint64_t first, std::size_t count, double* values)> draw;
};

/// A measurement equation of the evaluation used: EquationCard, and the formulas of a scenario.
struct Equation {
  std::string text, where;
};

/// An axis of the machine, from the bed outwards: AxisCard.
struct AxisRecord {
  std::string name, carries, kind, direction; ///< "C", "workpiece" or "tool", "linear" or "rotary", "Z"
  std::array<double, 3> point{};              ///< m
};

struct Results {
  std::string title, model, model_title, method, evaluation, scenario_file, scenario_text, scenario_hash;
  std::string version, git_hash, instruction_set, design;
  std::string date, host; ///< when (UTC, ISO 8601) and where the run began; empty: not recorded
  double duration = 0;    ///< s, of this call: a resumed run took longer
  std::uint64_t seed = 0, samples = 0, failed = 0;
  double coverage_probability = 0.95;
  std::vector<std::string> failures;   ///< "never_covered: 12 samples, first 345"
  std::vector<std::string> notes;
  std::vector<quantities::Reading> readings;
  std::vector<std::string> condition_names, condition_units, indication_names, indication_units; ///< SI units
  std::vector<std::string> condition_shown, indication_shown; ///< units in which they are stated
  std::vector<Equation> equations;
  std::vector<AxisRecord> axes;
  std::vector<InputRecord> inputs;
  std::vector<Summary> summaries;
  std::vector<Budget> budgets;
  std::vector<Validation> validations;
  std::vector<Sensitivity> sensitivities;
  std::vector<ComparisonResult> comparisons;
  std::vector<PrintedResult> printed;
  std::vector<PredictedReading> predicted; ///< of a prediction of readings that were taken
  std::vector<Shapley> shapley;
  std::vector<GivenData> given_data;
  std::vector<Morris> morris;
  std::vector<Dgsm> dgsm;
  std::vector<OneAtATimeTable> one_at_a_time;
  std::vector<JointRegion> joint;
  std::vector<FitCovariance> fits; ///< one, or none
  std::vector<CircularSummary> circular;
  std::vector<ConformityResult> conformity;
  std::vector<TargetResult> targets;
  StoppingRecord stopping;
  InputDraws draws; ///< empty unless they are stored
};

} // namespace gumshoe::analysis
