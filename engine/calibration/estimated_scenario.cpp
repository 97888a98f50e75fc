#include "calibration/estimated_scenario.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "base/version.h"
#include "scenario/write.h"

namespace gumshoe::calibration {
namespace {

using scenario::Member;
using scenario::Node;

Node text(std::string value) {
  Node out;
  out.kind = Node::Kind::text;
  out.text = std::move(value);
  return out;
}
Node number(double value) {
  Node out;
  out.kind = Node::Kind::real;
  out.number = value;
  return out;
}
Node list(std::vector<Node> items) {
  Node out;
  out.kind = Node::Kind::array;
  out.items = std::move(items);
  return out;
}
/// "5.2 mm", or a bare number without dimension.
Node measure(double si, const Unknown& u, units::Kind kind) {
  const double shown = units::from_si(si, u.unit, u.si_unit, kind);
  return u.unit == "1" ? number(shown) : text(fmt::format("{} {}", shown, u.unit));
}

Node* find(Node& table, const std::string& key) {
  for (Member& m : table.members)
    if (m.key == key) return &m.value;
  return nullptr;
}
Node& member(Node& table, const std::string& key) {
  if (Node* known = find(table, key)) return *known;
  table.members.push_back({key, 0, 0, {}});
  return table.members.back().value;
}
void erase(Node& table, const std::string& key) {
  std::erase_if(table.members, [&](const Member& m) { return m.key == key; });
}

/// Where "quantity", "effect.quantity" or "effect.size" of a stated effect stands.
Node& place_of(Node& document, const scenario::Scenario& s, const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) return member(member(document, "quantities"), name);
  const std::string effect = name.substr(0, dot);
  const bool stated =
      std::ranges::find(s.stated_effects, effect, &scenario::StatedEffect::name) != s.stated_effects.end();
  return member(member(member(document, stated ? "stated_effects" : "effects"), effect), name.substr(dot + 1));
}

/// The data file that was read in place of the scenario's own.
void replace_readings(Node& document, const std::string& file) {
  if (Node* indications = find(document, "indications"))
    for (Member& m : indications->members)
      if (Node* readings = find(m.value, "readings"))
        if (Node* old = find(*readings, "file")) *old = text(file);
}

/// Data files are named relative to the scenario's folder.
void move_paths(Node& node, const std::filesystem::path& from, const std::filesystem::path& to) {
  for (Member& m : node.members) {
    if (m.key == "file" && m.value.kind == Node::Kind::text) {
      const std::filesystem::path path = m.value.text;
      if (path.is_relative()) m.value.text = std::filesystem::relative(from / path, to).generic_string();
    }
    move_paths(m.value, from, to);
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

} // namespace

std::string estimated_scenario(const propagation::Experiment& experiment, const Estimate& estimate,
                               const std::string& folder) {
  const auto& s = experiment.scenario();
  for (const Parameter& p : estimate.parameters) {
    if (std::isinf(p.standard_uncertainty))
      refuse(s.file, p.unknown.name + ": the data do not determine it", "it has no distribution to be written",
             "a prior (u), another reading, or leave it out of the fit?");
    if (!std::isfinite(p.standard_uncertainty))
      refuse(s.file, p.unknown.name + ": nothing says how uncertain it is",
             "no reading is left over and no noise declared", "repeatability = { s = \"...\" }?");
  }
  Node document = scenario::parse_document(s.text, s.file);
  const auto here = std::filesystem::absolute(s.file).parent_path();
  const auto there = std::filesystem::absolute(folder.empty() ? "." : folder);
  if (std::filesystem::weakly_canonical(here) != std::filesystem::weakly_canonical(there))
    move_paths(document, here, there);
  if (!s.data.empty())
    replace_readings(document, std::filesystem::relative(std::filesystem::absolute(s.data), there).generic_string());
  const std::string source =
      fmt::format("gumshoe estimate of {}, {} readings, hash of scenario and data {}",
                  std::filesystem::path(s.file).filename().string(), estimate.rows.size(), s.hash);
  const bool t = s.estimate.t && !estimate.noise_declared;
  std::vector<std::size_t> uncertain;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const Parameter& p = estimate.parameters[i];
    const auto& quantity = s.quantities[p.unknown.quantity];
    Node* place = &place_of(document, s, quantity.name);
    erase(*place, "estimated");
    for (const auto& [label, value] : quantity.entries[p.unknown.entry].labels)
      place = &member(member(member(*place, "by"), label), value);
    Node known;
    known.members.push_back({"value", 0, 0, measure(p.value, p.unknown, units::Kind::point)});
    if (p.standard_uncertainty > 0) {
      if (t) known.members.push_back({"distribution", 0, 0, text("t")});
      known.members.push_back({"u", 0, 0, measure(p.standard_uncertainty, p.unknown, units::Kind::difference)});
      if (!estimate.noise_declared)
        known.members.push_back({"degrees_of_freedom", 0, 0, number(estimate.degrees_of_freedom)});
      known.members.push_back({"evaluation", 0, 0, text("A")});
      uncertain.push_back(i);
    }
    known.members.push_back({"source", 0, 0, text(source)});
    *place = known;
  }
  if (uncertain.size() > 1) {
    Node correlation;
    std::vector<Node> names, matrix;
    for (const std::size_t i : uncertain) {
      names.push_back(text(estimate.parameters[i].unknown.name));
      std::vector<Node> row;
      for (const std::size_t j : uncertain)
        row.push_back(number(estimate.correlation[i * estimate.parameters.size() + j]));
      matrix.push_back(list(std::move(row)));
    }
    correlation.members = {{"quantities", 0, 0, list(std::move(names))},
                           {"kind", 0, 0, text("pearson")},
                           {"matrix", 0, 0, list(std::move(matrix))},
                           {"source", 0, 0, text(source)}};
    // What tied the priors is in the fit now.
    if (Node* old = find(document, "correlations"))
      std::erase_if(old->items, [&](Node& item) {
        const Node* tied = find(item, "quantities");
        return tied && std::any_of(tied->items.begin(), tied->items.end(), [&](const Node& n) {
                 return std::any_of(estimate.parameters.begin(), estimate.parameters.end(),
                                    [&](const Parameter& p) { return n.text.starts_with(p.unknown.name); });
               });
      });
    Node& all = member(document, "correlations");
    all.kind = Node::Kind::array;
    all.items.push_back(std::move(correlation));
  }
  return opening(s.text) + fmt::format("# Written by gumshoe {}: {}.\n\n", version, source) +
         scenario::to_toml(document);
}

} // namespace gumshoe::calibration
