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

/// Depth first, in file order; empty if no number here carries a unit.
std::string first_unit(const Node& node) {
  if (node.kind == Node::Kind::text) {
    try {
      const std::string unit = units::parse(node.text).unit;
      return unit == "1" ? "" : unit;
    } catch (const InputError&) {
      return "";
    }
  }
  for (const Member& m : node.members) {
    if (std::ranges::find(worded, m.key) != worded.end()) continue;
    if (m.key == "unit" && m.value.kind == Node::Kind::text) return m.value.text;
  }
  for (const Member& m : node.members) {
    if (std::ranges::find(worded, m.key) != worded.end()) continue;
    const auto unit = first_unit(m.value);
    if (unit.empty()) continue;
    const bool relative = std::ranges::find(widths, m.key) != widths.end() && units::convertible(unit, "1");
    if (!relative) return unit;
  }
  for (const Node& item : node.items)
    if (auto unit = first_unit(item); !unit.empty()) return unit;
  return "";
}

std::vector<Symbol> symbols(Table& top, const char* key, Problems& problems) {
  std::vector<Symbol> out;
  auto table = top.table(key);
  if (!table) return out;
  for (const Member& m : table->members()) {
    if (const auto reserved = formula::reserved_as(m.key); !reserved.empty())
      problems.add(m, fmt::format("{}: this name is {}", table->path(m.key), reserved),
                   "a formula could not tell the two apart", "rename it");
    const std::string unit = declared_unit(m.value);
    const auto si_unit = read_si_unit(m.value, table->path(m.key), unit, problems);
    out.push_back({m.key, si_unit ? unit : "1", si_unit.value_or("1"), ""});
  }
  return out;
}

const Node* member(const Node& node, std::string_view key) {
  const auto it = std::ranges::find(node.members, key, &Member::key);
  return it == node.members.end() ? nullptr : &it->value;
}

/// Conditions that are columns of a data file.
void add_conditions(const Node* named, const std::string& path, const std::map<std::string, std::string>& units,
                    std::vector<Symbol>& conditions, Problems& problems) {
  if (!named) return;
  for (const Member& m : named->members) {
    if (std::ranges::find(conditions, m.key, &Symbol::name) != conditions.end()) continue;
    std::string unit = unit_of_column(m.value, units);
    if (unit.empty() || is_unknown_unit(unit)) unit = "1";
    if (const auto si_unit = read_si_unit(m.value, path + '.' + m.key, unit, problems))
      conditions.push_back({m.key, unit, *si_unit, ""});
  }
}

/// Conditions that only [data] or readouts name, and the units of indications that [data] states.
void add_data(Table& top, Declared& out, Problems& problems) {
  const Node* const data = member(top.node(), "data");
  const auto units = stated_units(data);
  if (data) add_conditions(member(*data, "conditions"), "data.conditions", units, out.conditions, problems);
  const Node* indications = member(top.node(), "indications");
  if (!indications) return;
  for (const Member& indication : indications->members) {
    const Node* readings = member(indication.value, "readings");
    if (!readings) continue;
    const std::string path = fmt::format("indications.{}.readings", indication.key);
    add_conditions(member(*readings, "conditions"), path + ".conditions", units, out.conditions, problems);
    const std::string unit = unit_of_column(*readings, units);
    if (unit.empty() || is_unknown_unit(unit)) continue;
    const auto symbol = std::ranges::find(out.indications, indication.key, &Symbol::name);
    const auto si_unit = read_si_unit(*readings, path, unit, problems);
    if (si_unit && symbol != out.indications.end()) *symbol = {indication.key, unit, *si_unit, ""};
  }
}

} // namespace

std::string declared_unit(const Node& node) {
  const std::string unit = first_unit(node);
  return unit.empty() ? "1" : unit;
}

Declared declared_symbols(Table& top, Problems& problems) {
  Declared out{symbols(top, "quantities", problems), symbols(top, "conditions", problems),
               symbols(top, "indications", problems)};
  add_data(top, out, problems);
  return out;
}

} // namespace gumshoe::scenario
