#include "scenario/analysis.h"

#include <algorithm>

#include "scenario/studies.h"

namespace gumshoe::scenario {
namespace {

Options<Comparison> comparison_options() {
  return {
      option::by_hand<Comparison>(measurand_key()),
      option::text("between", &Comparison::between, "label whose values are compared").needed("between = \"rod\""),
      option::text("within", &Comparison::within, "label held fixed"),
  };
}

Options<Printed> printed_options(const std::string& si_unit) {
  return {
      option::by_hand<Printed>(measurand_key()),
      option::by_hand<Printed>(labels_key()),
      option::measure("value", &Printed::value, {si_unit}, "the figure as printed, with its unit").needed(),
      option::source(&Printed::source),
  };
}

SensitivityOptions read_sensitivity(Table table) {
  SensitivityOptions out;
  read_options(table, sensitivity_options(), out);
  if (out.by_quantity && out.sobol == 0)
    table.refuse_key("by", "needs a base size", "it applies to Sobol' indices", "sobol = 65536");
  if (out.second_order && out.sobol == 0) table.refuse_key("second_order", "needs a base size", "", "sobol = 65536");
  table.refuse_unknown();
  return out;
}

/// Names of measurands of the evaluation, each once.
std::vector<std::string> known_measurands(const std::vector<Node>& items, const std::string& path,
                                          const StudyScope& scope, Problems& problems) {
  const std::vector<std::string> names = names_of(scope.model.measurands);
  std::vector<std::string> measurands;
  for (const Node& item : items) {
    const auto name = read_text(item, path, problems);
    if (!name) continue;
    if (std::ranges::find(names, *name) == names.end())
      problems.add(item, fmt::format("{}: '{}' is not a measurand here", path, *name), "", did_you_mean(*name, names));
    else if (std::ranges::find(measurands, *name) != measurands.end())
      problems.add(item, fmt::format("{}: '{}' is named twice", path, *name));
    measurands.push_back(*name);
  }
  return measurands;
}

std::vector<std::vector<std::string>> read_joint(Table& table, const StudyScope& scope) {
  std::vector<std::vector<std::string>> out;
  const auto* groups = table.array("joint");
  if (!groups) return out;
  const std::string path = table.path("joint");
  Problems& problems = table.problems();
  for (const Node& group : *groups) {
    const std::vector<std::string> measurands = known_measurands(group.items, path, scope, problems);
    if (group.kind != Node::Kind::array || measurands.size() < 2)
      problems.add(group, path + ": each group needs at least two measurands", "", "joint = [[\"a\", \"b\"]]");
    out.push_back(measurands);
  }
  return out;
}

void check_label(Table& table, const char* key, const std::string& name, const Context& context) {
  if (!name.empty()) context.is_label(*table.find(key), table.path(key), name);
}

Comparison read_comparison(Table table, const StudyScope& scope, Context& context) {
  Comparison out;
  if (const auto* m = read_measurand(table, scope.model)) out.measurand = m->name;
  read_options(table, comparison_options(), out);
  check_label(table, "between", out.between, context);
  check_label(table, "within", out.within, context);
  if (!out.between.empty() && out.between == out.within) table.refuse("between and within must be different labels");
  table.refuse_unknown();
  return out;
}

Printed read_printed(Table table, const StudyScope& scope, Context& context) {
  Printed out;
  const auto* measurand = read_subject(table, scope, context, out);
  if (!measurand) return out;
  read_options(table, printed_options(std::string(measurand->si_unit)), out);
  table.refuse_unknown();
  return out;
}

} // namespace

Options<SensitivityOptions> sensitivity_options() {
  using Studies = SensitivityOptions;
  const auto size = [](const char* key, std::uint64_t Studies::*member, const char* meaning) {
    constexpr std::int64_t largest = std::int64_t{1} << 30; // the results of larger ones fit into no memory
    return option::whole(key, member, 0, largest, meaning);
  };
  return {
      size("sobol", &Studies::sobol, "base size of the pick-freeze design; 0: no Sobol' indices"),
      size("shapley", &Studies::shapley, "rows of the Shapley design; inputs may be correlated; 0: none"),
      size("given_data", &Studies::given_data, "number of stored samples used for given-data indices; 0: none"),
      size("morris", &Studies::morris, "base points of the screening by elementary effects; 0: none"),
      size("dgsm", &Studies::dgsm, "points of the derivative-based measures; 0: none"),
      option::flag("second_order", &Studies::second_order, "adds second-order Sobol' indices; needs sobol"),
      option::word("by", &Studies::by_quantity, {{"draw", false}, {"quantity", true}},
                   "factor of the Sobol' indices: a single draw, or all draws of a quantity together"),
  };
}

Options<AnalysisOptions> analysis_options() {
  const auto rows = [](const char* key, const Shape& row, const char* meaning) {
    return option::by_hand<AnalysisOptions>(key, shape::list(row), meaning);
  };
  return {
      option::share("coverage_probability", &AnalysisOptions::coverage_probability, true, "coverage probability of "
                                                                                          "all coverage intervals"),
      option::texts("measurands", &AnalysisOptions::measurands, "",
                    "measurands that are printed and reported; default: all"),
      option::whole("validation_digits", &AnalysisOptions::validation_digits, 1, 6, "n_dig of JCGM 101 8.1"),
      option::by_hand<AnalysisOptions>("sensitivity", table_shape(sensitivity_options()),
                                       "studies, each with its size"),
      rows("joint", shape::list(shape::text(), R"("minItems": 2, "uniqueItems": true)"),
           "groups of measurands for joint coverage regions; default: the measurands of each reading"),
      rows("comparisons", table_shape(comparison_options()), "differences between readings, with E_n"),
      rows("printed", table_shape(printed_options("1")), "published figures, shown next to the computed ones"),
      rows("one_at_a_time", one_at_a_time_shape(),
           "moves each quantity in turn up and down by its step, with the others at their estimates"),
      rows("conformity", conformity_shape(), "does a measurand conform to its tolerance limits? JCGM 106"),
      rows("targets", target_shape(), "target uncertainties: which standard uncertainties would give this U?"),
  };
}

AnalysisOptions read_analysis(Table table, const StudyScope& scope, Context& context) {
  AnalysisOptions out;
  read_options(table, analysis_options(), out);
  if (auto sensitivity = table.table("sensitivity")) out.sensitivity = read_sensitivity(*sensitivity);
  if (const Node* chosen = table.find("measurands")) // one name or a list
    known_measurands(chosen->kind == Node::Kind::array ? chosen->items : std::vector<Node>{*chosen},
                     table.path("measurands"), scope, table.problems()); // the same problem twice is told once
  out.joint = read_joint(table, scope);
  for (const Table& row : table.tables("comparisons")) out.comparisons.push_back(read_comparison(row, scope, context));
  for (const Table& row : table.tables("printed")) out.printed.push_back(read_printed(row, scope, context));
  for (const Table& row : table.tables("one_at_a_time")) out.one_at_a_time.push_back(read_one_at_a_time(row, scope));
  for (const Table& row : table.tables("conformity")) out.conformity.push_back(read_conformity(row, scope, context));
  for (const Table& row : table.tables("targets")) out.targets.push_back(read_target(row, scope, context));
  table.refuse_unknown();
  return out;
}

} // namespace gumshoe::scenario
