#pragma once
/// The fields of a choice that its result file holds (analysis/fields.h).
#include "analysis/fields.h"
#include "choice/results.h"

namespace gumshoe::choice {

/// A variable and what the search found of it.
struct VariableRow {
  std::string name, kind, unit, si_unit;
  bool range = false, logarithmic = false;
  double resolution = 0, near_low = 0, near_high = 0;
};
std::vector<VariableRow> variable_rows(const Result& result);

struct CaseRow {
  std::string name, source, values;
};
std::vector<CaseRow> case_rows(const Result& result);

/// A candidate, one of the search or one with fresh numbers, and what only these have.
struct CandidateRow {
  const Candidate* candidate;
  const Figures* asked; ///< what the target is asked of
  std::string setting, name, source;
  double probability = 0;
};
std::vector<CandidateRow> candidate_rows(const Result& result);
/// The recommended setting first, then those it is compared with: all with fresh random numbers.
std::vector<CandidateRow> fresh_rows(const Result& result);

/// A setting in words, by variable.
std::string in_words(const Result& result, const std::vector<double>& values);

extern const analysis::Fields<Result> question_fields; ///< attributes
extern const analysis::Fields<VariableRow> variable_fields;
extern const analysis::Fields<CaseRow> case_fields;
extern const analysis::Fields<Figures> figure_fields; ///< in JSON, also of a case
extern const analysis::Fields<CandidateRow> candidate_fields, asked_fields; ///< of both kinds of candidates
extern const analysis::Fields<CandidateRow> searched_fields, fresh_fields;
extern const analysis::Fields<Neighbour> neighbour_fields;

} // namespace gumshoe::choice
