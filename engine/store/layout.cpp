#include "store/layout.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/result_fields.h"
#include "analysis/volume.h"
#include "choice/fields.h"
#include "tracing/findings/trace_fields.h"

namespace gumshoe::store {

using namespace analysis;

namespace {

struct FieldText {
  std::string key, json, csv, gauge, meaning;
  Unit unit;
};
struct TableText {
  std::string where, dimension, csv;
  std::vector<FieldText> fields;
};

template <class Row> TableText described(const Fields<Row>& table) {
  TableText text{std::string(table.where), std::string(table.dimension), std::string(table.csv), {}};
  for (const auto& f : table.list)
    text.fields.push_back({std::string(f.key), std::string(f.name(f.shown.json)), std::string(f.name(f.shown.csv)),
                           std::string(f.name(f.shown.gauge)), std::string(f.meaning), f.unit});
  return text;
}

std::vector<TableText> tables() {
  std::vector<TableText> all;
  const auto add = [&](const auto&... fields) { (all.push_back(described(fields)), ...); };
  add(equation_fields, axis_fields, input_fields, summary_fields, budget_fields, contribution_fields, validation_fields,
      comparison_fields, printed_fields, predicted_fields, sobol_study_fields, sobol_fields, pair_fields, shapley_study_fields, shapley_fields,
      given_data_study_fields, given_data_fields, delta_fields, rank_fields, morris_study_fields, morris_fields,
      dgsm_study_fields, dgsm_fields, one_at_a_time_fields, joint_fields, fit_fields, circular_fields, conformity_fields,
      target_study_fields, target_fields, stopping_fields);
  add(choice::question_fields, choice::variable_fields, choice::case_fields, choice::candidate_fields,
      choice::figure_fields, choice::asked_fields, choice::searched_fields, choice::fresh_fields, choice::neighbour_fields);
  add(volume_fields, volume_axis_fields, volume_point_fields, volume_share_fields);
  add(tracing::residual_fields, tracing::trace_fields, tracing::finding_fields, tracing::size_fields,
      tracing::candidate_fields, tracing::limit_fields, tracing::rms_fields, tracing::indication_error_fields,
      tracing::noise_fields, tracing::lack_of_fit_fields, tracing::anomalous_block_fields, tracing::outlier_fields);
  return all;
}

/// By position in analysis::In: as the README says it, and as the report's generator knows it.
struct KindText {
  const char *people, *name;
};
constexpr KindText kinds[] = {{"", "one"},
                              {"row's, a point", "point"},
                              {"row's", "difference"},
                              {"output's", "output"},
                              {"output's / row's", "coefficient"},
                              {"", "as_stated"},
                              {"", "units"},
                              {"", "output_units"},
                              {"", "run"}};
const KindText& kind_of(const Unit& unit) { return kinds[static_cast<int>(unit.in)]; }

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::string line(const FieldText& f, const std::string& json) {
  const bool units = f.unit.in == In::units;
  const std::string name = units ? "`units`, `display_units`, `display_factor`, `display_offset`" : code(f.key);
  std::string meaning = units ? "unit of the row" : f.meaning;
  for (std::size_t at = 0; (at = meaning.find('|', at)) != std::string::npos; at += 2) meaning.insert(at, "\\");
  return fmt::format("| {} | {} | {} | {} | {} | {} |\n", name,
                     f.unit.in == In::as_stated ? f.unit.stated : kind_of(f.unit).people, meaning, code(json),
                     code(f.csv), code(f.gauge));
}

} // namespace

std::string layout_markdown() {
  std::string text;
  const std::vector<TableText> all = tables();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TableText& table = all[i];
    if (i == 0 || table.where != all[i - 1].where || table.dimension != all[i - 1].dimension)
      text += fmt::format("\n**`{}/`** ({}{})\n\n| name | unit | meaning | JSON | CSV | gauge |\n|---|---|---|---|---|---|\n",
                        table.where, table.dimension.empty() ? "attributes" : table.dimension,
                        table.csv.empty() ? "" : "; `NAME_" + table.csv + ".csv`");
    for (const FieldText& f : table.fields) {
      std::string json = f.json;
      std::ranges::replace(json, '/', '.');
      if (f.unit.in != In::output_units && f.unit.in != In::run) text += line(f, json);
    }
  }
  return text;
}

std::string csv_columns_json() {
  nlohmann::ordered_json all;
  for (const TableText& table : tables()) {
    std::string where = table.where;
    if (const auto at = where.find("/<k>"); at != std::string::npos) where.erase(at, 4);
    for (const FieldText& f : table.fields)
      if (!f.csv.empty()) all[where].push_back({f.csv, f.key, kind_of(f.unit).name});
  }
  std::string text;
  for (const auto& [where, columns] : all.items()) {
    text += fmt::format("{}\n\"{}\": [", text.empty() ? "{" : ",", where);
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i ? ",\n  " : "\n  ") + columns[i].dump();
    text += "]";
  }
  return text + "}\n";
}

} // namespace gumshoe::store
