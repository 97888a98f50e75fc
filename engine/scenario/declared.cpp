#include "scenario/declared.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "formula/operation.h"
#include "scenario/number_column.h"

namespace gumshoe::scenario {
namespace {

constexpr std::array worded{"distribution", "evaluation", "source", "per",    "name",       "kind", "from", "same",
                            "labels",       "where",      "file",   "column", "conditions", "decimal"};
constexpr std::array widths{"u", "U", "half_width"}; ///< which may be shares of the value

struct StatedUnit {
  std::string unit;           ///< empty: none
  const Node* node = nullptr; ///< where it is written
};

/// Depth first, in file order; empty if no number here carries a unit.
StatedUnit first_unit(const Node& node) {
  if (node.kind == Node::Kind::text) {
    try {
      const std::string unit = units::parse(node.text).unit;
      return {unit == "1" ? "" : unit, &node};
    } catch (const InputError&) {
      return {};
    }
  }
  for (const Member& m : node.members) {
    if (std::ranges::find(worded, m.key) != worded.end()) continue;
    if (m.key == "unit" && m.value.kind == Node::Kind::text) return {m.value.text, &m.value};
  }
  for (const Member& m : node.members) {
    if (std::ranges::find(worded, m.key) != worded.end()) continue;
    if (m.key == "readings" && m.value.kind == Node::Kind::text) continue; // a column, though it be called "3D"
    auto found = first_unit(m.value);
    if (found.unit.empty()) continue;
    const bool relative = std::ranges::find(widths, m.key) != widths.end() && units::convertible(found.unit, "1");
    if (!relative) return found;
  }
  for (const Node& item : node.items)
    if (auto found = first_unit(item); !found.unit.empty()) return found;
  return {};
}

/// A value that is no number has no unit either, which would be blamed on a formula.
void refuse_no_number(const Node& node, const std::string& path, Problems& problems) {
  const Node* const inner = find_member(node, "value");
  const Node& value = inner ? *inner : node;
  if (value.kind != Node::Kind::text) return;
  try {
    units::parse(value.text);
  } catch (const InputError& error) {
    problems.add(value, inner ? path + ".value" : path, error);
  }
}

std::vector<Symbol> symbols(Table& top, const char* key, Problems& problems) {
  std::vector<Symbol> out;
  auto table = top.table(key);
  if (!table) return out;
  for (const Member& m : table->members()) {
    if (const auto reserved = formula::reserved_as(m.key); !reserved.empty())
      problems.add(m, fmt::format("{}: this name is {}", table->path(m.key), reserved),
                   "a formula could not tell the two apart", "rename it");
    if (key != std::string_view("indications")) refuse_no_number(m.value, table->path(m.key), problems);
    const StatedUnit stated = first_unit(m.value);
    const std::string unit = stated.unit.empty() ? "1" : stated.unit;
    const auto si_unit = read_si_unit(stated.node ? *stated.node : m.value, table->path(m.key), unit, problems);
    out.push_back({m.key, si_unit ? unit : "1", si_unit.value_or("1"), ""});
  }
  return out;
}

/// The name of the column that a node refers to, as its text or as { column = "x" }; empty if there is none, or if its
/// words stand for numbers.
std::string column_of(const Node& node) {
  if (node.kind == Node::Kind::text) return node.text;
  const Node* const column = find_member(node, "column");
  return column && column->kind == Node::Kind::text && !find_member(node, "map") ? column->text : "";
}

void note_without_unit(const Symbol& symbol, const Node& column, Declared& out) {
  if (const std::string name = column_of(column); symbol.unit == "1" && !name.empty())
    out.columns_without_unit.emplace_back(symbol.name, name);
}

/// Conditions that are columns of a data file.
void add_conditions(const Node* named, const std::string& path, const std::map<std::string, std::string>& units,
                    Declared& out, Problems& problems) {
  if (!named) return;
  for (const Member& m : named->members) {
    if (std::ranges::find(out.conditions, m.key, &Symbol::name) != out.conditions.end()) continue;
    std::string unit = unit_of_column(m.value, units);
    const bool stated = !unit.empty();
    if (unit.empty() || is_unknown_unit(unit)) unit = "1";
    if (const auto si_unit = read_si_unit(m.value, path + '.' + m.key, unit, problems)) {
      out.conditions.push_back({m.key, unit, *si_unit, ""});
      if (!stated) note_without_unit(out.conditions.back(), m.value, out);
    }
  }
}

/// Conditions that only [data] or readouts name, and the units of indications that [data] states.
void add_data(Table& top, Declared& out, Problems& problems) {
  const Node* const data = find_member(top.node(), "data");
  const auto units = stated_units(data);
  if (data) add_conditions(find_member(*data, "conditions"), "data.conditions", units, out, problems);
  const Node* indications = find_member(top.node(), "indications");
  if (!indications) return;
  for (const Member& indication : indications->members) {
    const Node* readings = find_member(indication.value, "readings");
    if (!readings) continue;
    const std::string path = fmt::format("indications.{}.readings", indication.key);
    add_conditions(find_member(*readings, "conditions"), path + ".conditions", units, out, problems);
    const std::string unit = unit_of_column(*readings, units);
    const auto symbol = std::ranges::find(out.indications, indication.key, &Symbol::name);
    if (unit.empty() && symbol != out.indications.end()) note_without_unit(*symbol, *readings, out);
    if (unit.empty() || is_unknown_unit(unit)) continue;
    const auto si_unit = read_si_unit(*readings, path, unit, problems);
    if (si_unit && symbol != out.indications.end()) *symbol = {indication.key, unit, *si_unit, ""};
  }
}

} // namespace

Declared declared_symbols(Table& top, Problems& problems) {
  Declared out{symbols(top, "quantities", problems), symbols(top, "conditions", problems),
               symbols(top, "indications", problems)};
  add_data(top, out, problems);
  return out;
}

} // namespace gumshoe::scenario
