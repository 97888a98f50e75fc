#include "propagation/table_columns.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/units.h"
#include "scenario/reader.h"

namespace gumshoe::propagation {
namespace {

constexpr Limits any{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

std::vector<Slot> slots_of(const models::Model& model) {
  std::vector<Slot> slots;
  const auto add = [&](const std::string& prefix, const auto& q, const Limits& limits, const EffectCard* effect) {
    slots.push_back(
        {prefix + std::string(q.name), std::string(q.unit), std::string(q.si_unit), q.default_value, limits, effect});
  };
  for (const auto& q : model.card->quantities) add("", q, q.limits, nullptr);
  for (const EffectCard* e : effects::cards())
    if (effects::applies(*model.card, *e))
      for (const auto& q : e->quantities) add(std::string(e->name) + ".", q, q.limits, e);
  for (const auto& i : model.card->indications) add("", i, any, nullptr);
  for (const auto& c : model.card->conditions) add("", c, any, nullptr);
  return slots;
}

/// The scenario's estimates and conditions instead of the card's defaults, and the effects that it frees.
void take_values(const Experiment& values, const ModelCard& card, std::vector<Slot>& slots) {
  const scenario::Scenario& s = values.scenario();
  const Points estimates = values.estimates();
  const auto take = [&](std::string_view name, const auto& at_reading) {
    const auto slot = std::ranges::find(slots, name, &Slot::name);
    if (slot == slots.end()) return;
    slot->value = at_reading(0);
    slot->freed = slot->effect != nullptr;
    for (std::size_t r = 1; r < s.readings.size(); ++r) slot->one = slot->one && at_reading(r) == slot->value;
  };
  for (std::size_t q = 0; q < values.layout().indications.begin; ++q)
    take(s.quantities[q].name, [&](std::size_t r) { return estimates[r][q]; });
  for (std::size_t i = 0; i < card.conditions.size(); ++i)
    take(card.conditions[i].name, [&](std::size_t r) { return s.readings[r].conditions[i]; });
}

/// "beam_pitch (deg)" -> name and unit; a name without brackets has unit 1.
std::pair<std::string, std::string> split_header(const std::string& text) {
  const auto open = text.find('(');
  if (open == std::string::npos || text.back() != ')') return {text, "1"};
  std::string name = text.substr(0, open), unit = text.substr(open + 1, text.size() - open - 2);
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return {name, unit};
}

Problem beyond_limits(const Slot& slot, const Csv& table, const CsvCell& cell, const std::string& unit) {
  const auto shown = [&](double v) { return units::from_si(v, slot.unit, slot.si_unit); };
  return {table.at(cell), fmt::format("{}: {} {} is impossible", slot.name, cell.text, unit),
          fmt::format("limits {}{:g}, {:g}{} {}", slot.limits.low_open ? "above " : "", shown(slot.limits.low),
                      shown(slot.limits.high), slot.limits.high_open ? " excluded" : "", slot.unit),
          ""};
}

void read_cells(Slot& slot, const std::string& unit, const Csv& table, char decimal, TableColumns& out) {
  const auto index = static_cast<std::size_t>(slot.given_column);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const CsvCell& cell = table.rows[r][index];
    try {
      slot.column.push_back(units::to_si(table.number(cell, decimal), unit, slot.si_unit));
      if (slot.limits.contain(slot.column.back())) continue;
      out.bad_row[r] = true;
      out.impossible.push_back(beyond_limits(slot, table, cell, unit));
    } catch (const InputError& error) {
      Problem p = error.problems().front();
      if (p.where.file.empty()) p.where = table.at(cell);
      p.what = slot.name + ": " + p.what;
      if (!p.remedy.empty())
        p.remedy = fmt::format("add --decimal \"{}\"", decimal == ',' ? '.' : ','); // no key of a scenario
      out.problems.push_back(p);
      slot.column.push_back(0);
    }
  }
}

void read_column(std::size_t c, const Csv& table, char decimal, TableColumns& out) {
  const auto [name, unit] = split_header(table.header[c].text);
  const Location where = table.at(table.header[c]);
  const auto slot = std::ranges::find(out.slots, name, &Slot::name);
  if (slot == out.slots.end()) {
    std::vector<std::string> names;
    for (const Slot& s : out.slots) names.push_back(s.name);
    out.problems.push_back(
        {where, "unknown column '" + name.substr(0, 60) + "'", "", scenario::did_you_mean(name, names)});
    return;
  }
  if (slot->given_column >= 0) {
    out.problems.push_back({where, "column '" + name + "' is listed twice", "", "remove one of them"});
    return;
  }
  slot->given_column = static_cast<int>(c);
  if (name == table.header[c].text && slot->si_unit != "1") {
    out.problems.push_back({where, fmt::format("the column '{}' states no unit", name), "",
                            fmt::format("write it behind the name: {} ({})", name, slot->unit)});
    return;
  }
  try {
    units::to_si(1, unit, slot->si_unit);
  } catch (const InputError& error) {
    Problem p = error.problems().front();
    p.where = where;
    p.what = name + ": " + p.what;
    out.problems.push_back(p);
    return;
  }
  read_cells(*slot, unit, table, decimal, out);
}

} // namespace

const Slot* TableColumns::given(std::string_view name) const {
  for (const Slot& s : slots)
    if (s.name == name && s.given_column >= 0) return &s;
  return nullptr;
}

TableColumns table_columns(const models::Model& model, const Csv& table, const Experiment* values, char decimal) {
  TableColumns out;
  out.slots = slots_of(model);
  if (values) take_values(*values, *model.card, out.slots);
  out.bad_row.assign(table.rows.size(), false);
  for (std::size_t c = 0; c < table.header.size(); ++c) read_column(c, table, decimal, out);
  for (const Slot& s : out.slots)
    if (s.effect && (s.freed || s.given_column >= 0) && std::ranges::find(out.acting, s.effect) == out.acting.end())
      out.acting.push_back(s.effect);
  for (const Slot& s : out.slots)
    if (!s.one && s.given_column < 0)
      out.problems.push_back({{table.file},
                              fmt::format("column '{}' is missing", s.name),
                              "the scenario has several values of it",
                              fmt::format("add a column '{} ({})'", s.name, s.unit)});
  std::erase_if(out.slots,
                [&](const Slot& s) { return s.effect && std::ranges::find(out.acting, s.effect) == out.acting.end(); });
  return out;
}

} // namespace gumshoe::propagation
