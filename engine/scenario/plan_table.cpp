#include "scenario/plan_table.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "scenario/number_column.h"

namespace gumshoe::scenario {
namespace {

PlanColumn* find(std::vector<PlanColumn>& columns, const Node& name) {
  const Node* const column = name.kind == Node::Kind::table ? find_member(name, "column") : &name;
  if (!column || column->kind != Node::Kind::text) return nullptr;
  const auto it = std::ranges::find(columns, column->text, &PlanColumn::header);
  return it == columns.end() ? nullptr : &*it;
}

/// Words that stand for numbers: map = { up = 1, down = -1 }.
std::vector<std::pair<std::string, double>> map_of(const Node& column, const std::string& si_unit) {
  std::vector<std::pair<std::string, double>> out;
  const Node* const map = find_member(column, "map");
  for (const Member& m : map ? map->members : std::vector<Member>{}) {
    if (m.value.kind != Node::Kind::text) {
      out.emplace_back(m.key, m.value.number);
      continue;
    }
    const auto measure = units::parse(m.value.text);
    out.emplace_back(m.key, units::to_si(measure.number, measure.unit, si_unit));
  }
  return out;
}

void fill(std::vector<PlanColumn>& columns, const Node& of, const ModelCard& model, const Node* data) {
  if (const Node* labels = find_member(of, "labels"))
    for (const Member& m : labels->members)
      if (PlanColumn* column = find(columns, m.value)) {
        column->holds = PlanColumn::Holds::label;
        column->label = m.key;
      }
  if (const Node* conditions = find_member(of, "conditions"))
    for (const Member& m : conditions->members)
      for (std::size_t c = 0; c < model.conditions.size(); ++c) {
        PlanColumn* const column = model.conditions[c].name == m.key ? find(columns, m.value) : nullptr;
        if (!column || find_member(m.value, "clock")) continue; // the time of day is read at the machine
        column->holds = PlanColumn::Holds::condition;
        column->condition = c;
        column->si_unit = model.conditions[c].si_unit;
        const std::string unit = unit_of_column(m.value, stated_units(data));
        column->unit = unit.empty() ? column->si_unit : unit;
        column->words = map_of(m.value, column->si_unit);
      }
}

std::string header(std::string_view name, std::string_view unit) {
  return unit == "1" ? std::string(name) : fmt::format("{} ({})", name, unit);
}

PlanColumn of_condition(const ModelCard& model, std::size_t c) {
  const VariableCard& card = model.conditions[c];
  return {header(card.name, card.unit), PlanColumn::Holds::condition, {}, c,
          std::string(card.unit),       std::string(card.si_unit)};
}

/// Conditions and labels without a column that vary over the allowed readings, or between these and the readings taken.
void add_missing(std::vector<PlanColumn>& columns, const PlanScope& scope, const std::vector<AllowedReading>& allowed) {
  using enum PlanColumn::Holds;
  const auto has = [&](const auto& is_it) { return std::ranges::any_of(columns, is_it); };
  for (const AllowedReading& reading : allowed)
    for (const auto& label : reading.labels)
      if (!has([&](const PlanColumn& p) { return p.holds == PlanColumn::Holds::label && p.label == label.first; }))
        columns.push_back({label.first, PlanColumn::Holds::label, label.first});
  for (std::size_t c = 0; c < scope.model.conditions.size(); ++c) {
    if (has([&](const PlanColumn& p) { return p.holds == condition && p.condition == c; })) continue;
    std::set<double> values;
    for (const AllowedReading& reading : allowed) values.insert(reading.conditions[c]);
    for (const auto& reading : scope.scenario.readings) values.insert(reading.conditions[c]);
    if (values.size() > 1) columns.push_back(of_condition(scope.model, c));
  }
}

std::vector<PlanColumn> own_columns(const PlanScope& scope, const Context& context) {
  std::vector<PlanColumn> out;
  using enum PlanColumn::Holds;
  const auto is_condition = [&](const std::string& name) {
    return std::ranges::find(scope.model.conditions, name, &VariableCard::name) != scope.model.conditions.end();
  };
  for (const std::string& label : context.label_names())
    if (!is_condition(label)) out.push_back({label, PlanColumn::Holds::label, label});
  for (std::size_t c = 0; c < scope.model.conditions.size(); ++c) out.push_back(of_condition(scope.model, c));
  for (const VariableCard& card : scope.model.indications) out.push_back({header(card.name, card.unit)});
  return out;
}

} // namespace

std::vector<PlanColumn> plan_columns(const PlanScope& scope, const std::vector<AllowedReading>& allowed,
                                     Context& context) {
  const auto& readouts = scope.readouts;
  if (readouts.empty() || !readouts.front().file || !readouts.front().file->csv) return own_columns(scope, context);
  std::vector<PlanColumn> out;
  for (const std::string& name : readouts.front().file->csv->names()) out.push_back({name});
  if (context.data) fill(out, *context.data, scope.model, context.data);
  if (scope.indications)
    for (const Member& m : scope.indications->members)
      if (const Node* readings = find_member(m.value, "readings")) fill(out, *readings, scope.model, context.data);
  add_missing(out, scope, allowed);
  return out;
}

} // namespace gumshoe::scenario
