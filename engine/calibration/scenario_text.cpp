#include "calibration/scenario_text.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "base/units.h"
#include "base/version.h"
#include "quantities/cells.h"
#include "quantities/effect_of.h"
#include "scenario/quantity.h"
#include "scenario/set_points.h"
#include "scenario/write.h"

namespace gumshoe::calibration {

using scenario::Member;
using scenario::Node;

Node text_node(std::string value) {
  Node out;
  out.kind = Node::Kind::text;
  out.text = std::move(value);
  return out;
}

Node number_node(double value) {
  Node out;
  out.kind = Node::Kind::real;
  out.number = value;
  return out;
}

Node list_node(std::vector<Node> items) {
  Node out;
  out.kind = Node::Kind::array;
  out.items = std::move(items);
  return out;
}

Node measure_node(double si, const std::string& unit, const std::string& si_unit, bool difference) {
  const double shown = units::from_si(si, unit, si_unit, difference ? units::Kind::difference : units::Kind::point);
  return unit == "1" ? number_node(shown) : text_node(fmt::format("{} {}", shown, unit));
}

Node& member(Node& table, const std::string& key) {
  if (Node* known = find_member(table, key)) return *known;
  table.members.push_back({key, 0, 0, {}});
  return table.members.back().value;
}

void erase_member(Node& table, const std::string& key) {
  std::erase_if(table.members, [&](const Member& m) { return m.key == key; });
}

namespace {

/// The data file that was read in place of the scenario's own.
void replace_readings(Node& document, const std::string& file) {
  if (Node* indications = find_member(document, "indications"))
    for (Member& m : indications->members)
      if (Node* readings = find_member(m.value, "readings"))
        if (Node* old = find_member(*readings, "file")) *old = text_node(file);
  if (Node* data = find_member(document, "data"))
    if (Node* old = find_member(*data, "file")) *old = text_node(file);
}

/// Whether the keys of a section are names that its author chose, of which one may be "file".
bool holds_names(const std::string& section) {
  constexpr std::array sections{"quantities",    "stated_effects", "conditions", "indications", "measurands",
                                "intermediates", "units",          "labels",     "columns",     "variables",
                                "time",          "priors",         "by",         "where",       "map"};
  return std::ranges::find(sections, section) != sections.end();
}

/// Data files are named relative to the scenario's folder.
/// @param names  keys of the table are names
void move_paths(Node& node, const std::filesystem::path& from, const std::filesystem::path& to, bool names = false) {
  for (Member& m : node.members) {
    if (!names && (m.key == "file" || m.key == "form") && m.value.kind == Node::Kind::text) {
      const std::filesystem::path path = m.value.text;
      if (path.is_relative()) m.value.text = std::filesystem::relative(from / path, to).generic_string();
    }
    if (m.key == "from" && m.value.kind == Node::Kind::text) // "results.h5:laser_z"; a measure has no colon
      if (const std::size_t colon = m.value.text.rfind(':', m.value.text.find('[')); colon != std::string::npos)
        if (const std::filesystem::path path = m.value.text.substr(0, colon); path.is_relative())
          m.value.text = std::filesystem::relative(from / path, to).generic_string() + m.value.text.substr(colon);
    move_paths(m.value, from, to, !names && holds_names(m.key));
  }
  for (Node& item : node.items) move_paths(item, from, to);
}

/// The comment lines with which the text opens.
std::string opening(const std::string& scenario) {
  std::string out;
  for (std::size_t at = 0; at < scenario.size() && scenario[at] == '#';) {
    const std::size_t end = scenario.find('\n', at);
    const std::string line = scenario.substr(at, end == std::string::npos ? end : end - at);
    if (!line.starts_with("#:")) out += line + '\n'; // editors' schema lines hold a relative path
    at = end == std::string::npos ? scenario.size() : end + 1;
  }
  return out;
}

/// Whether a draw, "rod_length[rod 2]: seat", is one of this quantity, or of these of its draws, "rod_length[rod 2]".
bool is_draw_of(const std::string& draw, const std::string& name) {
  return draw.starts_with(name) && (draw.size() == name.size() || draw[name.size()] == '[' || draw[name.size()] == ':');
}

/// Takes the draws of these quantities out of a stated correlation. True if no two are left to be tied.
bool untied(Node& correlation, const std::vector<std::string>& names) {
  Node* tied = find_member(correlation, "quantities");
  if (!tied) return false;
  Node* matrix = find_member(correlation, "matrix");
  for (std::size_t i = tied->items.size(); i-- > 0;) {
    if (std::ranges::none_of(names, [&](const std::string& name) { return is_draw_of(tied->items[i].text, name); }))
      continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    tied->items.erase(tied->items.begin() + at);
    if (!matrix) continue;
    matrix->items.erase(matrix->items.begin() + at);
    for (Node& row : matrix->items) row.items.erase(row.items.begin() + at);
  }
  return tied->items.size() < 2;
}

} // namespace

ScenarioText::ScenarioText(const scenario::Scenario& s, const std::string& folder)
    : scenario_(s), document_(scenario::parse_document(s.text, s.file)) {
  std::vector<std::string> notes;
  scenario::DataFiles files(s.file, s.data, notes);
  scenario::Problems problems(s.file);
  scenario::expand_set_points(document_, files, problems);
  const auto here = std::filesystem::absolute(s.file).parent_path();
  const auto there = std::filesystem::absolute(folder.empty() ? "." : folder);
  if (std::filesystem::weakly_canonical(here) != std::filesystem::weakly_canonical(there))
    move_paths(document_, here, there);
  if (!s.data.empty())
    replace_readings(document_, std::filesystem::relative(std::filesystem::absolute(s.data), there).generic_string());
}

Node& ScenarioText::quantity(const std::string& name) {
  const std::string effect = quantities::effect_of(name);
  if (effect.empty()) return member(member(document_, "quantities"), name);
  Node* effects = find_member(document_, "stated_effects");
  const bool stated = effects && find_member(*effects, effect);
  return member(member(member(document_, stated ? "stated_effects" : "effects"), effect),
                name.substr(effect.size() + 1));
}

Node& ScenarioText::entry(const std::string& name, const quantities::Labels& labels) {
  Node* place = &quantity(name);
  quantities::Labels held;
  for (;;) {
    if (Node* by = find_member(*place, "by")) { // one label per by-table
      Member& label = by->members.front();
      held.emplace_back(label.key, *quantities::label_value(labels, label.key));
      const Node* const others = find_member(label.value, scenario::any_other);
      const bool own = find_member(label.value, held.back().second);
      const Node as_others = others && !own ? *others : Node{};
      place = &member(label.value, held.back().second);
      if (others && !own) *place = as_others;
      continue;
    }
    const auto missing =
        std::ranges::find_if(labels, [&](const auto& l) { return !quantities::label_value(held, l.first); });
    if (missing == labels.end()) return *place;
    split(*place, name, held, missing->first);
  }
}

void ScenarioText::split(Node& leaf, const std::string& name, const quantities::Labels& held,
                         const std::string& label) {
  Node table, rows, copy = leaf;
  for (const char* key : {"estimated", "unit"}) // said once, of the whole quantity
    if (const Node* known = find_member(leaf, key)) {
      table.members.push_back({key, 0, 0, *known});
      erase_member(copy, key);
    }
  if (copy.kind == Node::Kind::table && copy.members.empty()) // not in the text: its default
    for (const auto& q : scenario_.quantities)
      if (q.name == name) copy = measure_node(q.entries.front().value, q.unit, q.si_unit, false);
  for (const auto& reading : scenario_.readings)
    if (const std::string* value = quantities::label_value(reading.labels, label);
        value && quantities::holds_for(held, reading.labels))
      member(rows, *value) = copy;
  member(member(table, "by"), label) = std::move(rows);
  leaf = std::move(table);
}

void ScenarioText::tie(const std::vector<std::string>& names, const std::vector<double>& matrix,
                       const std::string& kind, const std::string& source) {
  Node correlation;
  std::vector<Node> members, rows;
  for (std::size_t i = 0; i < names.size(); ++i) {
    members.push_back(text_node(names[i]));
    std::vector<Node> row;
    for (std::size_t j = 0; j < names.size(); ++j) row.push_back(number_node(matrix[i * names.size() + j]));
    rows.push_back(list_node(std::move(row)));
  }
  correlation.members = {{"quantities", 0, 0, list_node(std::move(members))},
                         {"kind", 0, 0, text_node(kind)},
                         {"matrix", 0, 0, list_node(std::move(rows))},
                         {"source", 0, 0, text_node(source)}};
  if (Node* old = find_member(document_, "correlations"))
    std::erase_if(old->items, [&](Node& item) { return untied(item, names); });
  Node& all = member(document_, "correlations");
  all.kind = Node::Kind::array;
  all.items.push_back(std::move(correlation));
  // Sobol' indices are defined for independent inputs, Shapley effects for all.
  Node* analysis = find_member(document_, "analysis");
  Node* sensitivity = analysis ? find_member(*analysis, "sensitivity") : nullptr;
  Node* sobol = sensitivity ? find_member(*sensitivity, "sobol") : nullptr;
  if (!sobol) return;
  const Node rows_of_design = *sobol;
  for (const char* key : {"sobol", "second_order", "by"}) erase_member(*sensitivity, key);
  if (rows_of_design.number > 0 && !find_member(*sensitivity, "shapley"))
    sensitivity->members.push_back({"shapley", 0, 0, rows_of_design});
}

std::string ScenarioText::text(const std::string& written) const {
  return opening(scenario_.text) + fmt::format("# Written by gumshoe {}: {}.\n\n", version, written) +
         scenario::to_toml(document_);
}

} // namespace gumshoe::calibration
