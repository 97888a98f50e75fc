#include "store/choice_file.h"

#include "choice/fields.h"
#include "store/field_writer.h"
#include "store/results_writer.h"
#include "store/whole_file.h"

namespace gumshoe::store {

using choice::CandidateRow;
using choice::Figures;
using choice::Result;

namespace {

void write_question(hid_t group, const Result& r) {
  const Display shown = display(r.unit, r.si_unit);
  hdf5::write_attribute(group, "units", r.si_unit);
  hdf5::write_attribute(group, "display_units", shown.units);
  hdf5::write_attribute(group, "display_factor", shown.factor);
  hdf5::write_attribute(group, "display_offset", 0.0); // an error is a difference
  write_attributes(group, choice::question_fields, r);
}

/// Figures of some candidates, over the dimensions of the table and `case`.
void write_figures(hid_t group, Table& table, const Result& r, const std::vector<CandidateRow>& rows) {
  propagation::Output measurand;
  measurand.si_unit = r.si_unit;
  write_fields(table, choice::candidate_fields, rows, measurand);
  write_fields(table, choice::asked_fields, rows, measurand);
  write_fields(table, choice::figure_fields, column(rows, [](const auto& c) { return c.candidate->average; }),
               measurand);
  if (r.asked.cases.empty()) return;
  table.numbers("worst", column(rows, [](const auto& c) { return std::uint64_t{c.candidate->worst}; }), "1",
                "case of the largest U, by position in cases");
  const Table cases(group, "case", r.asked.cases.size());
  const auto matrix = [&](const char* name, double Figures::*member, const char* what) {
    std::vector<double> values;
    for (const CandidateRow& row : rows)
      for (const Figures& f : row.candidate->cases) values.push_back(f.*member);
    table.matrix(name, cases, values, r.si_unit, what);
  };
  matrix("case_expanded", &Figures::expanded, "expanded uncertainty in each case, with the average's correction");
  matrix("case_expanded_se", &Figures::expanded_se, "Monte Carlo standard error of it");
  matrix("case_mean", &Figures::mean, "mean error in each case");
  matrix("case_left", &Figures::left, "mean of the error that the correction leaves in each case");
}

void write_candidates(hid_t parent, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "candidates");
  const auto rows = choice::candidate_rows(r);
  Table table(group, "candidate", rows.size());
  const Table variables(group, "variable", r.asked.variables.size());
  std::vector<double> values;
  for (const auto& c : r.candidates) values.insert(values.end(), c.values.begin(), c.values.end());
  const auto si = column(r.asked.variables, [](const scenario::Variable& v) { return v.knob.si_unit; });
  table.matrix("values", variables, values, common_units(si),
               "value of each variable; of an evaluation its position in evaluations");
  write_fields(table, choice::searched_fields, rows);
  write_figures(group, table, r, rows);
}

void write_fresh(hid_t parent, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "fresh");
  const auto rows = choice::fresh_rows(r);
  Table table(group, "row", rows.size());
  write_fields(table, choice::fresh_fields, rows);
  write_figures(group, table, r, rows);
}

void write_choice_group(hid_t file, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(file, "choice");
  write_question(group, r);
  write_table(file, choice::variable_fields, choice::variable_rows(r));
  if (!r.asked.cases.empty()) write_table(file, choice::case_fields, choice::case_rows(r));
  write_candidates(group, r);
  write_fresh(group, r);
  if (!r.neighbours.empty()) write_table(file, choice::neighbour_fields, r.neighbours);
  std::vector<analysis::Sensitivity> sobol;
  std::vector<analysis::Shapley> shapley;
  if (!r.sensitivity.indices.empty()) sobol.push_back(r.sensitivity);
  if (!r.shapley.effects.empty()) shapley.push_back(r.shapley);
  write_sensitivity(group, sobol, shapley);
  write_list(group, "evaluations", r.evaluations, "evaluations of the model, by position");
  write_list(group, "skipped_why", r.skipped_why, "why some combinations are impossible");
  write_list(file, "notes", r.notes, "decisions and warnings a reader must see");
}

} // namespace

void write_choice(Draft& draft, const Claim& claim, const scenario::Scenario& s, const Result& r) {
  Identity identity = identity_of(s);
  identity.command = "choose";
  identity.seed = r.seed;
  identity.samples = r.asked.confirm_samples;
  write_whole(draft, claim, identity, s, [&](hid_t file) { write_choice_group(file, r); });
}

} // namespace gumshoe::store
