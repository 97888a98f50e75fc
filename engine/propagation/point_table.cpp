#include "propagation/point_table.h"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "base/units.h"
#include "formula/finite.h"
#include "propagation/forward_model.h"
#include "propagation/table_columns.h"
#include "scenario/reader.h"

namespace gumshoe::propagation {
namespace {

/// The evaluation asked for, by index; complaints go to `problems`.
std::size_t chosen_evaluation(const ModelCard& card, const std::string& evaluation, std::vector<Problem>& problems) {
  std::size_t chosen = card.evaluations.size();
  for (std::size_t i = 0; i < card.evaluations.size(); ++i)
    if (evaluation.empty() ? i == 0 : card.evaluations[i].name == evaluation) chosen = i;
  if (chosen < card.evaluations.size()) return chosen;
  std::vector<std::string> names;
  for (const EvaluationCard& e : card.evaluations) names.emplace_back(e.name);
  problems.push_back({{}, "unknown evaluation '" + evaluation + "'", "", scenario::did_you_mean(evaluation, names)});
  return chosen;
}

/// Where a model indicates nothing, its measurands follow from the quantities alone.
bool is_indicated(const ModelCard& card, const TableColumns& columns) {
  return card.indications.empty() ||
         std::ranges::any_of(card.indications, [&](const auto& i) { return columns.given(i.name) != nullptr; });
}

/// Either all indications are given and no measurand that follows from them, or none; a joint evaluation needs them.
void check_indications(const ModelCard& card, const Csv& table, std::size_t evaluation, TableColumns& columns) {
  const bool indicated = is_indicated(card, columns);
  for (const auto& i : card.indications)
    if (indicated && !columns.given(i.name))
      columns.problems.push_back(
          {{table.file}, fmt::format("column '{}' is missing", i.name), "the other indications are given", ""});
  for (const auto& m : card.measurands)
    if (const Slot* s = columns.given(m.name); s && indicated)
      columns.problems.push_back({table.at(table.header[static_cast<std::size_t>(s->given_column)]),
                                  "column '" + s->name + "' is what the indications are evaluated for",
                                  "here it is an output", "remove one of them"});
  if (evaluation < card.evaluations.size() && card.evaluations[evaluation].joint() && !indicated)
    columns.problems.push_back(
        {{table.file},
         fmt::format("no column of readings: '{}' evaluates them together", card.evaluations[evaluation].name),
         "",
         fmt::format("add a column '{} ({})'", card.indications[0].name, card.indications[0].unit)});
}

/// The model with a table's rows as its readings.
struct TablePoints {
  Points points;
  ForwardModel forward;
};

TablePoints table_points(const models::Model& model, const Csv& table, std::size_t evaluation,
                         const TableColumns& columns) {
  const std::size_t quantities = columns.slots.size() - model.card->conditions.size();
  Points points(table.rows.size());
  std::vector<std::vector<double>> conditions(table.rows.size());
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t i = 0; i < columns.slots.size(); ++i)
      (i < quantities ? points : conditions)[r].push_back(columns.slots[i].at(r));
  return {std::move(points), ForwardModel(model, columns.acting, evaluation, std::move(conditions))};
}

Location place_of(const Csv& table, std::size_t row) {
  return table.rows[row].empty() ? Location{table.file} : Location{table.file, table.rows[row][0].line, 1};
}

/// Reasons why formulas have no finite value, by row.
using NotFiniteRows = std::map<std::size_t, Problem>;

/// Marks rows that are impossible. Whether a row has a value although a formula has none is known when it is evaluated:
/// a table without readings does not need the formulas of the measurands.
NotFiniteRows check_rows(const TablePoints& at, const Csv& table, const TableColumns& columns, PointTable& result,
                         std::vector<bool>& bad_row) {
  NotFiniteRows out;
  for (std::size_t r = 0; r < table.rows.size(); ++r) try {
      const std::string problem = at.forward.check(r, at.points[r]);
      if (problem.empty()) continue;
      bad_row[r] = true;
      if (!columns.bad_row[r]) result.impossible.push_back({place_of(table, r), problem, "physically impossible", ""});
    } catch (const formula::NotFinite& error) {
      out.emplace(r, error.reason()).first->second.where = place_of(table, r);
    }
  return out;
}

/// A column of results, NaN where the status is not ok.
void add_column(const VariableCard& v, const std::vector<double>& values, const std::vector<Status>& status,
                PointTable& result) {
  result.header.push_back(fmt::format("{} ({})", v.name, v.unit));
  result.columns.emplace_back();
  for (std::size_t i = 0; i < status.size(); ++i)
    result.columns.back().push_back(status[i] == Status::ok
                                        ? units::from_si(values[i], std::string(v.unit), std::string(v.si_unit))
                                        : std::numeric_limits<double>::quiet_NaN());
}

/// A joint evaluation: every row of the table is a reading, and there is one result.
void evaluate_together(const TablePoints& at, const Csv& table, bool possible, PointTable& result) {
  const auto measurands = at.forward.measurands(at.points[0].data());
  const std::string problem = possible ? at.forward.check_together(at.points) : std::string();
  if (!problem.empty()) result.impossible.push_back({{table.file}, problem, "", ""});
  Responses found{measurands.size(), std::vector<double>(measurands.size()), {Status::out_of_domain}};
  if (possible && problem.empty()) {
    result.notes = at.forward.remarks(at.points);
    const Variation none;
    found = at.forward.measurands(at.points, {&none, 1});
  }
  result.joint = true;
  for (std::size_t m = 0; m < measurands.size(); ++m) add_column(measurands[m], {found.at(0, m)}, found.status, result);
  result.status = {status_name(found.status[0])};
}

/// Every row of the table is a sample of one reading.
void evaluate_rows(const TablePoints& at, const std::vector<Slot>& slots, const std::vector<bool>& bad_row,
                   bool indicated, PointTable& result) {
  const std::size_t rows = bad_row.size(), n = padded(rows);
  const ModelCard& card = *at.forward.model().card;
  BlockValues found;
  if (rows > 0) {
    std::vector<std::vector<double>> values;
    std::vector<models::Column> columns;
    for (const Slot& s : slots) {
      values.push_back(s.column);
      if (!s.column.empty()) values.back().resize(n, s.column.back()); // the padding repeats the last row
      columns.push_back(s.column.empty() ? models::Column{&s.value, 0} : models::Column{values.back().data(), 1});
    }
    const std::span<const models::Column> all(columns);
    Block block;
    block.clear(n);
    at.forward.add(block, 0, all.first(at.forward.layout().size()), all.subspan(at.forward.layout().size()));
    found = indicated ? at.forward.evaluate(block) : at.forward.simulate(block);
  }
  std::vector<Status> status;
  for (std::size_t r = 0; r < rows; ++r)
    status.push_back(bad_row[r] ? Status::out_of_domain : static_cast<Status>(found.status[r]));
  const auto row = [&](const std::vector<double>& from, std::size_t i) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(i * n);
    return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(rows));
  };
  for (std::size_t i = 0; i < card.measurands.size(); ++i) {
    // Simulation repeats its input, the true measurand.
    const bool is_quantity =
        std::ranges::find(card.quantities, card.measurands[i].name, &QuantityCard::name) != card.quantities.end();
    if (indicated || !is_quantity) add_column(card.measurands[i], row(found.measurands, i), status, result);
  }
  if (!indicated)
    for (std::size_t i = 0; i < card.indications.size(); ++i)
      add_column(card.indications[i], row(found.indications, i), status, result);
  for (const Status s : status) result.status.emplace_back(status_name(s));
}

} // namespace

PointTable evaluate_points(const models::Model& model, const Csv& table, const std::string& evaluation,
                           const Experiment* values, char decimal) {
  TableColumns columns = table_columns(model, table, values, decimal);
  std::vector<Problem> unknown;
  const std::size_t chosen = chosen_evaluation(
      *model.card, evaluation.empty() && values ? values->scenario().evaluation : evaluation, unknown);
  check_indications(*model.card, table, chosen, columns);
  columns.problems.insert(columns.problems.end(), unknown.begin(), unknown.end());
  if (!columns.problems.empty()) throw InputError(columns.problems);
  const bool indicated = is_indicated(*model.card, columns), together = model.card->evaluations[chosen].joint();
  if (together && table.rows.empty())
    throw InputError({{{table.file}, "the table has no rows", "each row is a reading", ""}});
  PointTable result;
  result.impossible = columns.impossible;
  std::vector<bool> bad_row = columns.bad_row;
  const TablePoints at = table_points(model, table, chosen, columns);
  const NotFiniteRows not_finite = check_rows(at, table, columns, result, bad_row);
  if (together) {
    evaluate_together(at, table, std::ranges::find(bad_row, true) == bad_row.end(), result);
    return result;
  }
  evaluate_rows(at, columns.slots, bad_row, indicated, result);
  for (const auto& [row, reason] : not_finite)
    if (result.status[row] == status_name(Status::not_finite)) result.impossible.push_back(reason);
  return result;
}

} // namespace gumshoe::propagation
