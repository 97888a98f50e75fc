#include "store/choice_writer.h"

#include <cmath>

#include "choice/choose.h"
#include "store/results_writer.h"
#include "store/table.h"

namespace gumshoe::store {

using choice::Candidate;
using choice::Figures;
using choice::Result;

namespace {

constexpr const char* kinds[] = {"condition", "quantity", "readings", "evaluation"};

std::string words(const Result& r, const std::vector<double>& values) {
  std::vector<scenario::Setting> settings;
  for (std::size_t v = 0; v < values.size(); ++v) settings.push_back({r.asked.variables[v].knob, values[v]});
  return choice::in_words(settings, r.evaluations);
}

void write_question(hid_t group, const Result& r) {
  const auto& asked = r.asked;
  const Display shown = display(r.unit, r.si_unit);
  const std::pair<const char*, std::string> texts[] = {
      {"measurand", asked.measurand},         {"units", r.si_unit},
      {"display_units", shown.units},         {"target_of", asked.worst_case ? "worst_case" : "average"},
      {"definition", name(asked.definition)}, {"statement", r.statement}};
  for (const auto& [name, text] : texts) hdf5::write_attribute(group, name, text);
  const std::pair<const char*, double> numbers[] = {{"display_factor", shown.factor},
                                                    {"display_offset", 0},
                                                    {"target", asked.target},
                                                    {"bias_limit", asked.bias.value_or(std::nan(""))},
                                                    {"confirm_probability", asked.confirm_probability},
                                                    {"near_share", asked.near},
                                                    {"probability", r.probability}};
  for (const auto& [name, x] : numbers) hdf5::write_attribute(group, name, x);
  const std::pair<const char*, std::uint64_t> counts[] = {
      {"samples", asked.samples}, {"confirm_samples", asked.confirm_samples},
      {"reached", r.reached},     {"confirmed", r.confirmed},
      {"best", r.best},           {"tried", r.tried},
      {"skipped", r.skipped},     {"near_count", r.near_count}};
  for (const auto& [name, n] : counts) hdf5::write_attribute(group, name, n);
}

void write_variables(hid_t parent, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "variables");
  const auto& variables = r.asked.variables;
  using V = scenario::Variable;
  Table table(group, "variable", variables.size());
  table.texts("name", column(variables, [](const V& v) { return v.knob.name; }), "what may be chosen");
  table.texts("kind", column(variables, [](const V& v) { return std::string(kinds[static_cast<int>(v.knob.kind)]); }),
              "condition, quantity, readings or evaluation");
  const auto si = column(variables, [](const V& v) { return v.knob.si_unit; });
  const std::string units = common_units(si);
  table.units(si, column(variables, [](const V& v) { return v.knob.unit; }));
  table.numbers("range", column(variables, [](const V& v) { return v.range ? 1 : 0; }), "1",
                "1: a range, refined; 0: a list");
  table.numbers("logarithmic", column(variables, [](const V& v) { return v.logarithmic ? 1 : 0; }), "1",
                "1: even steps on a logarithmic scale");
  table.numbers("resolution", r.resolution, "1", "last step as share of the range on its scale, 0 of a list");
  std::vector<double> low, high;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    low.push_back(r.near_count > 0 ? r.near[v].low : std::nan(""));
    high.push_back(r.near_count > 0 ? r.near[v].high : std::nan(""));
  }
  table.numbers("near_low", low, units, "least value among settings that meet the target in nearly the least time");
  table.numbers("near_high", high, units, "largest value among these; NaN if there is none");
}

/// Figures of some candidates, over the dimensions `dimension` and `case`.
void write_figures(hid_t group, Table& table, const Result& r, const std::vector<const Candidate*>& rows) {
  using C = const Candidate*;
  const std::string& units = r.si_unit;
  const bool worst = r.asked.worst_case;
  const auto lengths = [&](const char* name, double Figures::*member, const char* what) {
    table.numbers(name, column(rows, [&](C c) { return c->average.*member; }), units, what);
  };
  table.numbers("time", column(rows, [](C c) { return c->time; }), "s", "time that measuring takes");
  table.numbers("readings", column(rows, [](C c) { return static_cast<std::uint64_t>(c->readings); }), "1",
                "number of readings");
  lengths("mean", &Figures::mean, "mean error, the bias, over all uncertain quantities");
  lengths("mean_se", &Figures::mean_se, "Monte Carlo standard error of the mean error");
  lengths("standard_deviation", &Figures::standard_deviation, "standard deviation of the error");
  lengths("expanded", &Figures::expanded, "expanded uncertainty U over all uncertain quantities");
  lengths("expanded_se", &Figures::expanded_se, "Monte Carlo standard error of U");
  table.numbers("asked", column(rows, [&](C c) { return asked(*c, worst).expanded; }), units,
                "expanded uncertainty that the target is asked of: of the average, or of the worst case");
  table.numbers("asked_se", column(rows, [&](C c) { return asked(*c, worst).expanded_se; }), units,
                "Monte Carlo standard error of it");
  table.numbers("valid", column(rows, [](C c) { return c->average.valid; }), "1", "samples with a value");
  table.numbers("failed", column(rows, [](C c) { return c->average.failed; }), "1", "samples without a value");
  table.numbers("meets", column(rows, [](C c) { return c->meets ? 1 : 0; }), "1",
                "1 if target and limit of the bias are met by these numbers");
  if (r.asked.cases.empty()) return;
  table.numbers("worst", column(rows, [](C c) { return static_cast<std::uint64_t>(c->worst); }), "1",
                "case of the largest U, by position in cases");
  const Table cases(group, "case", r.asked.cases.size());
  const auto matrix = [&](const char* name, double Figures::*member, const char* what) {
    std::vector<double> values;
    for (C c : rows)
      for (const Figures& f : c->cases) values.push_back(f.*member);
    table.matrix(name, cases, values, units, what);
  };
  matrix("case_expanded", &Figures::expanded, "expanded uncertainty in each case, with the average's correction");
  matrix("case_expanded_se", &Figures::expanded_se, "Monte Carlo standard error of it");
  matrix("case_mean", &Figures::mean, "mean error in each case");
  matrix("case_left", &Figures::left, "mean of the error that the correction leaves in each case");
}

void write_values(hid_t group, Table& table, const Result& r, const std::vector<const Candidate*>& rows) {
  const Table variables(group, "variable", r.asked.variables.size());
  std::vector<double> values;
  for (const Candidate* c : rows) values.insert(values.end(), c->values.begin(), c->values.end());
  std::vector<std::string> si;
  for (const auto& v : r.asked.variables) si.push_back(v.knob.si_unit);
  table.matrix("values", variables, values, common_units(si),
               "value of each variable; of an evaluation its position in evaluations");
  table.texts("setting", column(rows, [&](const Candidate* c) { return words(r, c->values); }), "setting in words");
}

void write_candidates(hid_t parent, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "candidates");
  std::vector<const Candidate*> rows;
  for (const Candidate& c : r.candidates) rows.push_back(&c);
  Table table(group, "candidate", rows.size());
  write_values(group, table, r, rows);
  write_figures(group, table, r, rows);
  table.numbers("pareto", column(rows, [](const Candidate* c) { return c->pareto ? 1 : 0; }), "1",
                "1 if nothing tried beats it in both time and U");
  table.numbers("round", column(rows, [](const Candidate* c) { return c->round; }), "1",
                "0: coarse grid, then refinements, last the optimum's neighbours");
}

/// The recommended setting first, then those it is compared with: all with fresh random numbers.
void write_fresh(hid_t parent, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(parent, "fresh");
  std::vector<const Candidate*> rows{&r.fresh};
  std::vector<std::string> names{"recommended"}, sources{""}, settings{words(r, r.fresh.values)};
  std::vector<double> probabilities{r.probability};
  for (const auto& c : r.compared) {
    rows.push_back(&c.candidate);
    names.push_back(c.name);
    sources.push_back(c.source);
    settings.push_back(c.setting);
    probabilities.push_back(c.probability);
  }
  Table table(group, "row", rows.size());
  table.texts("name", names, "recommended, then the settings compared with it");
  table.texts("setting", settings, "setting in words");
  table.texts("source", sources, "where a compared setting comes from");
  table.numbers("probability", probabilities, "1", "probability that it meets the target, from the standard errors");
  write_figures(group, table, r, rows);
}

void write_neighbours(hid_t parent, const Result& r) {
  if (r.neighbours.empty()) return;
  const hdf5::Handle group = hdf5::create_group(parent, "neighbours");
  using N = choice::Neighbour;
  Table table(group, "neighbour", r.neighbours.size());
  table.numbers("variable", column(r.neighbours, [](const N& n) { return static_cast<std::uint64_t>(n.variable); }),
                "1", "the variable that differs from the optimum's, by position in variables");
  table.numbers("candidate", column(r.neighbours, [](const N& n) { return static_cast<std::uint64_t>(n.candidate); }),
                "1", "position in candidates");
  table.numbers("time_ratio", column(r.neighbours, &N::time_ratio), "1", "time over the optimum's");
  table.numbers("expanded_ratio", column(r.neighbours, &N::expanded_ratio), "1",
                "U over the optimum's, with common random numbers");
  table.numbers("near", column(r.neighbours, [](const N& n) { return n.near ? 1 : 0; }), "1",
                "1 if neither is larger by more than near_share");
}

void write_cases(hid_t parent, const Result& r) {
  const auto& cases = r.asked.cases;
  if (cases.empty()) return;
  const hdf5::Handle group = hdf5::create_group(parent, "cases");
  using C = scenario::ChooseCase;
  Table table(group, "case", cases.size());
  table.texts("name", column(cases, &C::name), "case");
  table.texts("source", column(cases, &C::source), "where it comes from");
  table.texts("values", column(cases, [&](const C& c) { return choice::in_words(c.values, r.evaluations); }),
              "true values of quantities in it");
}

} // namespace

void write_choice_group(hid_t file, const Result& r) {
  const hdf5::Handle group = hdf5::create_group(file, "choice");
  write_question(group, r);
  write_variables(group, r);
  write_cases(group, r);
  write_candidates(group, r);
  write_fresh(group, r);
  write_neighbours(group, r);
  std::vector<analysis::Sensitivity> sobol;
  std::vector<analysis::Shapley> shapley;
  if (!r.sensitivity.indices.empty()) sobol.push_back(r.sensitivity);
  if (!r.shapley.effects.empty()) shapley.push_back(r.shapley);
  write_sensitivity(group, sobol, shapley);
  write_list(group, "evaluations", r.evaluations, "evaluations of the model, by position");
  write_list(group, "skipped_why", r.skipped_why, "why some combinations cannot be");
  write_list(file, "notes", r.notes, "decisions and warnings a reader must see");
}

} // namespace gumshoe::store
