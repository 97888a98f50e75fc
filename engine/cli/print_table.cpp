// Results as JSON and CSV: what the tables of fields say, in the units people are shown.
#include <iostream>

#include <fmt/format.h>

#include "analysis/fields_json.h"
#include "analysis/result_fields.h"
#include "base/csv.h"
#include "base/json_text.h"
#include "cli/print.h"
#include "cli/print_studies.h"

namespace gumshoe::cli {

namespace {
using namespace analysis;

/// One line of a CSV table: names in the first pass, then values.
struct CsvLine {
  std::string text;
  bool head = false, begun = false;
  void add(const std::string& name, const std::string& value) {
    text += (begun ? "," : "") + (head ? name : value);
    begun = true;
  }
};

template <class Row>
void add_cells(CsvLine& line, const Fields<Row>& fields, const Row& row, const propagation::Output& output,
               const std::string& prefix = {}, std::string_view Shown::*shown_as = &Shown::csv) {
  const RowUnit unit = unit_of(row), of_output{output.unit, output.si_unit};
  for (const auto& field : fields.list) {
    const std::string_view name = field.name(field.shown.*shown_as);
    if (name.empty() || field.unit.in == In::run) continue;
    std::string cell;
    if (!field.get)
      cell = field.unit.in == In::output_units ? output.unit : unit.shown;
    else
      std::visit(
          [&]<class T>(const T& value) {
            if constexpr (std::is_same_v<T, double>)
              cell = fmt::format("{:.15g}", converted(value, field.unit, unit, of_output));
            else if constexpr (std::is_same_v<T, std::string>)
              cell = csv_quoted(value);
            else
              cell = fmt::format("{}", value);
          },
          field.get(row));
    line.add(prefix + std::string(name), cell);
    if (field.unit.in == In::coefficient)
      line.add(prefix + std::string(name) + "_unit", coefficient_unit(unit, of_output));
  }
}

Json run_json(const Results& r, const std::string& file) {
  return {{"title", r.title},
          {"file", file},
          {"scenario", r.scenario_file},
          {"hash", r.scenario_hash},
          {"version", r.version},
          {"model", r.model},
          {"method", r.method},
          {"evaluation", r.evaluation},
          {"design", r.design},
          {"seed", r.seed},
          {"samples", r.samples},
          {"failed", r.failed},
          {"date", r.date},
          {"host", r.host},
          {"duration_s", r.duration},
          {"failures", r.failures},
          {"notes", r.notes}};
}

Json budget_json(const Budget& b) {
  Json rows = Json::array();
  for (const Contribution& c : b.contributions) {
    rows.push_back(json(contribution_fields, c, b.output));
    rows.back()["sensitivity_unit"] = coefficient_unit(unit_of(c), unit_of(b));
  }
  return rows;
}

} // namespace

void print_json(const Results& r, const std::string& file) {
  Json all = Json::array();
  const Json run = run_json(r, file);
  for (std::size_t o = 0; o < r.summaries.size(); ++o) {
    const Summary& s = r.summaries[o];
    Json object = json(summary_fields, s);
    object["coverage_probability"] = r.coverage_probability;
    Json labels = Json::object();
    for (const auto& [name, value] : s.output.labels) labels[name] = value;
    object["labels"] = labels;
    object["gum"] = json(budget_fields, r.budgets[o]);
    object["budget"] = budget_json(r.budgets[o]);
    object["validation"] = json(validation_fields, r.validations[o]);
    add_studies(r, s.output, object);
    for (const ComparisonResult& c : r.comparisons)
      if (c.a == s.output.name || c.b == s.output.name) object["comparisons"].push_back(json(comparison_fields, c));
    for (const PredictedReading& p : r.predicted)
      if (p.output == s.output.name) object["predicted"] = json(predicted_fields, p);
    for (const PrintedResult& p : r.printed)
      if (p.output == s.output.name) object["printed"].push_back(json(printed_fields, p));
    object["run"] = run;
    all.push_back(std::move(object));
  }
  std::cout << json_text(all) << '\n';
}

void print_csv(const Results& r, bool budget) {
  bool headed = false;
  const auto print = [&](const auto& add) {
    for (const bool head : {true, false}) {
      if (head && headed) continue;
      CsvLine text{{}, head};
      add(text);
      std::cout << text.text << '\n';
    }
    headed = true;
  };
  for (std::size_t o = 0; o < r.summaries.size(); ++o) {
    const propagation::Output& output = r.summaries[o].output;
    if (!budget)
      print([&](CsvLine& text) {
        add_cells(text, summary_fields, r.summaries[o], output);
        text.add("coverage_probability", fmt::format("{}", r.coverage_probability));
        add_cells(text, budget_fields, r.budgets[o], output, "gum_", &Shown::json);
        add_cells(text, validation_fields, r.validations[o], output, "validation_", &Shown::json);
      });
    else
      for (const Contribution& c : r.budgets[o].contributions)
        print([&](CsvLine& text) {
          text.add("output", csv_quoted(output.name));
          add_cells(text, contribution_fields, c, output);
        });
  }
}

} // namespace gumshoe::cli
