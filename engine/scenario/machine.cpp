#include "scenario/machine.h"

#include <map>
#include <set>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

using chain::AxisDescription;
using chain::MachineDescription;

constexpr std::string_view axis_name = R"("type": "string", "pattern": "^[XYZUVWABC][0-9]*$")";

std::vector<Key> axis_keys() {
  return {
      {"axis", Shape(axis_name), "X, Y, Z, U, V, W are linear axes, A, B, C rotary axes; a number may follow", true},
      {"kind", shape::words({"linear", "rotary"}), "may be stated and is checked"},
      {"point", shape::list(shape::reference("measure"), R"("minItems": 3, "maxItems": 3)"),
       "design point on the axis, with the machine at zero"},
      {"sense", R"("enum": [1, -1])",
       "of the component's motion at a positive command; by default 1 on the tool side, -1 on the workpiece side "
       "(ISO 841)"},
  };
}

std::vector<Key> machine_keys() {
  const Shape axes = shape::list(shape::any_of({Shape(axis_name), shape::table(axis_keys())}));
  std::string known;
  for (const std::string& name : names_of(chain::machines())) known += (known.empty() ? "" : ", ") + name;
  const std::string errors =
      R"("patternProperties": {"^E_[XYZABC]0?[XYZUVWABC][0-9]*$": {)" + shape::reference("measure") + "}}";
  return {
      {"name", shape::text() + R"(, "examples": )" + shape::quoted(names_of(chain::machines())),
       known + "; with the two sides any other"},
      {"workpiece_side", axes, "axes that carry the workpiece, from the bed outwards; [] if nothing moves"},
      {"tool_side", axes, "axes that carry the tool, from the bed outwards; [] if nothing moves"},
      {"errors", shape::table({}, errors),
       "known errors by their names in ISO 230-1 and -7; defaults of the quantities with these names"},
  };
}

class MachineReader {
public:
  MachineReader(Table table, Problems& problems) : table_(std::move(table)), problems_(problems) {}

  std::optional<MachineDescription> read() {
    const std::size_t before = problems_.size();
    table_.declare(machine_keys());
    MachineDescription out;
    const auto name = table_.text("name");
    const bool sides = table_.has("workpiece_side") || table_.has("tool_side");
    if (sides)
      out = {name.value_or(""), side("workpiece_side"), side("tool_side")};
    else if (const auto* known = named(name))
      out = *known;
    if (sides && name && chain::find_machine(*name))
      table_.refuse_key("name", fmt::format("'{}' is a predefined machine", *name), "its axes are already known",
                        "leave out the sides, or choose another name");
    if (auto errors = table_.table("errors")) read_errors(*errors, out);
    const std::size_t so_far = problems_.size();
    table_.refuse_unknown();
    misspelt_ = problems_.size() != so_far;
    if (sides || !out.name.empty())
      for (const chain::DescriptionProblem& p : chain::problems(out)) {
        if (told(p.place)) continue;
        const auto& [node, path] = place(p.place);
        problems_.add(*node, fmt::format("{}: {}", path, p.what), p.why, p.remedy);
      }
    return problems_.size() == before ? std::optional(std::move(out)) : std::nullopt;
  }

private:
  struct Place {
    const Node* node;
    std::string path;
  };

  const MachineDescription* named(const std::optional<std::string>& name) {
    const std::vector<std::string> names = names_of(chain::machines());
    if (name) {
      table_.choice("name", names);
      return chain::find_machine(*name);
    }
    if (!table_.has("name"))
      table_.refuse(
          "neither a name nor the two sides are given", "",
          fmt::format("name one of {}, or give workpiece_side = [\"A\"] and tool_side = [\"X\", \"Y\", \"Z\"]",
                      fmt::join(names, ", ")));
    return nullptr;
  }

  std::optional<std::vector<AxisDescription>> side(const std::string& key) {
    const auto* items = table_.array(key);
    if (!items) return std::nullopt;
    std::vector<AxisDescription> out;
    for (std::size_t i = 0; i < items->size(); ++i) {
      const Node& item = (*items)[i];
      const std::string place = fmt::format("{}[{}]", key, i), path = fmt::format("machine.{}[{}]", key, i + 1);
      places_[place] = {&item, path};
      if (item.kind != Node::Kind::table) {
        const auto text = read_text(item, path, problems_);
        if (!text) unreadable_.insert(place);
        out.push_back({text.value_or("")});
        continue;
      }
      Table row(item, path, problems_);
      out.push_back(axis(row, place));
    }
    return out;
  }

  AxisDescription axis(Table& row, const std::string& place) {
    AxisDescription out;
    row.declare(axis_keys());
    const Node* name = row.require("axis", "axis = \"C\"");
    const auto text = row.text("axis");
    if (name) places_[place] = {name, row.path()};
    if (!text) unreadable_.insert(place);
    out.name = text.value_or("");
    for (const char* key : {"kind", "sense", "point"})
      if (const Node* node = row.find(key)) places_[place + '.' + key] = {node, row.path(key)};
    out.kind = row.text("kind").value_or("");
    if (row.has("sense")) {
      const auto sense = row.number("sense");
      if (sense && *sense != 1 && *sense != -1)
        row.refuse_key("sense", fmt::format("{} is neither 1 nor -1", *sense),
                       "the sense of the component's motion at a positive command", "leave it out to follow ISO 841");
      else if (sense)
        out.sense = static_cast<int>(*sense);
    }
    if (const auto* point = row.array("point")) {
      if (point->size() != 3)
        row.refuse_key("point", "X, Y and Z are needed", "", "point = [\"0 mm\", \"0 mm\", \"-50 mm\"]");
      for (std::size_t i = 0; i < point->size() && point->size() == 3; ++i)
        out.point[i] = read_measure((*point)[i], row.path("point"), {"m"}, problems_).value_or(0);
    }
    row.refuse_unknown();
    return out;
  }

  void read_errors(Table& table, MachineDescription& out) {
    places_["errors"] = {&table.node(), table.path()};
    for (const Member& m : table.members()) {
      places_["errors." + m.key] = {&m.value, table.path(m.key)};
      const bool known_kind = m.key.size() > 3 && m.key.starts_with("E_");
      const bool angle = known_kind && std::string_view("ABC").find(m.key[2]) != std::string_view::npos;
      const bool length = known_kind && std::string_view("XYZ").find(m.key[2]) != std::string_view::npos;
      double value = 0;
      if (angle || length)
        value = read_measure(m.value, table.path(m.key), {angle ? "rad" : "m"}, problems_).value_or(0);
      out.errors.emplace_back(m.key, value);
    }
  }

  /// What could not be read is said already; a side that is not there may be a misspelt one.
  bool told(const std::string& at) {
    if (at == "workpiece_side" || at == "tool_side") return misspelt_ || table_.has(at);
    return unreadable_.contains(at) || (at.empty() && misspelt_);
  }

  /// A place of chain::problems in the file; the nearest known part of it.
  Place place(std::string at) {
    while (!at.empty()) {
      if (const auto it = places_.find(at); it != places_.end()) return it->second;
      const auto dot = at.rfind('.');
      at = dot == std::string::npos ? "" : at.substr(0, dot);
    }
    return {&table_.node(), "machine"};
  }

  Table table_;
  Problems& problems_;
  std::map<std::string, Place> places_; ///< by the places of chain::problems, which count from 0
  std::set<std::string> unreadable_;
  bool misspelt_ = false;
};

} // namespace

Shape machine_shape() {
  return shape::table(machine_keys(),
                      R"("dependencies": {"workpiece_side": ["tool_side"], "tool_side": ["workpiece_side"]}, )"
                      R"("anyOf": [{"required": ["name"]}, {"required": ["workpiece_side", "tool_side"]}])");
}

std::optional<MachineDescription> read_machine(Table& top, Problems& problems) {
  if (!top.require("machine", "[machine] name = \"TTTRR\"")) return std::nullopt;
  auto table = top.table("machine");
  return table ? MachineReader(*table, problems).read() : std::nullopt;
}

} // namespace gumshoe::scenario
