#pragma once
/// What a choice found, as plain data in SI units: what the file holds and the report shows.
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/results.h"
#include "scenario/choose_options.h"

namespace gumshoe::choice {

/// Statistics of the error e = stated - true over all uncertain quantities, or with those of a case at its values.
struct Figures {
  double mean = 0, mean_se = 0;         ///< mean of e: the bias
  double standard_deviation = 0;        ///< standard deviation of e
  double left = 0;                      ///< mean of what remains after the correction; uncorrected: the mean
  double expanded = 0, expanded_se = 0; ///< U and its Monte Carlo standard error
  std::uint64_t valid = 0, failed = 0;
};

/// One setting of the variables, and what is known of it.
struct Candidate {
  std::vector<double> values; ///< by variable, as scenario::Setting::value
  std::size_t readings = 1;   ///< in all
  double time = 0;            ///< s
  Figures average;
  std::vector<Figures> cases; ///< by case
  std::size_t worst = 0;      ///< case of the largest U
  int round = 0;              ///< 0: coarse grid; then refinements; one more: neighbours of the optimum
  bool meets = false;         ///< the target and the limit of the bias, by these numbers
  bool refuted = false;       ///< meets it by these numbers, and not by fresh ones, or would not
  bool pareto = false;        ///< nothing is faster with less U
};

/// What the target is asked of.
inline const Figures& asked(const Candidate& c, bool worst_case) { return worst_case ? c.cases[c.worst] : c.average; }

struct Compared {
  std::string name, source, setting; ///< in words
  Candidate candidate;               ///< without values
  double probability = 0;            ///< of meeting the target
};

/// One step from the optimum in one variable.
struct Neighbour {
  std::size_t variable = 0;
  std::size_t candidate = 0;
  double time_ratio = 0, expanded_ratio = 0; ///< to the optimum's, both of the search
  bool near = false;                         ///< neither is more than the stated share larger
};

/// Settings that meet the target in nearly the least time: the values of a variable among them.
struct Span {
  double low = 0, high = 0;
};

struct Result {
  scenario::Choose asked;
  std::string title, scenario_file, scenario_hash;
  std::string unit, si_unit;            ///< of the measurand
  std::vector<std::string> evaluations; ///< names by position in the card
  double coverage_probability = 0.95;
  std::uint64_t seed = 0;
  std::vector<Candidate> candidates;    ///< in the order in which they were tried
  std::uint64_t skipped = 0;            ///< combinations that cannot be: an evaluation of one reading with several
  std::vector<std::string> skipped_why; ///< each reason once
  bool reached = false;                 ///< some candidate meets the target
  bool confirmed = false;               ///< and the fresh numbers agree, with the probability asked for
  std::size_t best = 0;                 ///< recommended; not reached: the one of least U
  Candidate fresh;                      ///< the recommended one again, with fresh random numbers and more samples
  double probability = 0;               ///< that it meets the target, from the standard errors of the fresh numbers
  std::size_t tried = 0;                ///< candidates run afresh, with faster ones than the first that was confirmed
  analysis::Sensitivity sensitivity;    ///< of e at the recommended setting: what limits it
  analysis::Shapley shapley;            ///< the same for correlated inputs
  std::vector<Neighbour> neighbours;
  std::size_t near_count = 0;     ///< candidates that meet the target within the stated share of the least time
  std::vector<Span> near;         ///< by variable, over these
  std::vector<double> resolution; ///< by variable: last step of a range as share of it; 0 of a list
  std::vector<Compared> compared;
  std::vector<std::string> notes;
  std::string statement; ///< the recommendation in a sentence or two
};

} // namespace gumshoe::choice
