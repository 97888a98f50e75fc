#include "scenario/machine.h"

#include <map>
#include <set>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

using chain::AxisDescription;
using chain::MachineDescription;

constexpr std::string_view axis_name = R"("type": "string", "pattern": "^[XYZUVWABC][0-9]*$")";
constexpr std::string_view any_axis_name = R"("type": "string", "pattern": "^[XYZUVWABCJ][0-9]*$")";

Shape point_shape() { return shape::list(shape::reference("measure"), R"("minItems": 3, "maxItems": 3)"); }

/// Parameters of a link, each 0 unless stated.
std::vector<Key> link_keys() {
  const auto measure = shape::reference("measure");
  return {
      {"a", measure, "length of the link, along X; default 0 mm"},
      {"alpha", measure, "twist of the link, about X; default 0 deg"},
      {"d", measure, "offset along the joint's axis Z; default 0 mm"},
      {"theta", measure, "angle about the joint's axis Z at command 0; default 0 deg"},
  };
}

std::vector<Key> axis_keys() {
  return {
      {"axis", Shape(any_axis_name),
       "X, Y, Z, U, V, W are linear axes, A, B, C rotary axes, J joints stated by dh; a number may follow", true},
      {"kind", shape::words({"linear", "rotary"}), "may be stated and is checked; a joint is rotary unless stated"},
      {"point", point_shape(), "design point on the axis, with the machine at zero"},
      {"direction", shape::list(shape::number(), R"("minItems": 3, "maxItems": 3)"),
       "of an inclined axis, such as [0, 1, 1]; within 90 deg of its letter's, whose errors are inclined with it"},
      {"dh", shape::table(link_keys()),
       "the axis as a link by standard Denavit-Hartenberg parameters: Rz(theta) Tz(d) Tx(a) Rx(alpha)"},
      {"modified_dh", shape::table(link_keys()),
       "the same by modified parameters (Craig): Rx(alpha) Tx(a) Rz(theta) Tz(d)"},
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
      R"("patternProperties": {"^(E_[XYZABC]0?[XYZUVWABC]|delta_(a|alpha|d|theta|beta)_[XYZUVWABCJ])[0-9]*$": {)" +
      shape::reference("measure") + "}}";
  const std::string points = R"("patternProperties": {"^[XYZUVWABC][0-9]*$": {)" + point_shape() + "}}";
  return {
      {"name", shape::text() + R"(, "examples": )" + shape::json_string(names_of(chain::machines())),
       known + "; with the two sides any other"},
      {"workpiece_side", axes, "axes that carry the workpiece, from the bed outwards; [] if nothing moves"},
      {"tool_side", axes, "axes that carry the tool, from the bed outwards; [] if nothing moves"},
      {"points", shape::table({}, points), "design points on axes of a predefined machine, which meet at the origin"},
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
    if (auto points = table_.table("points")) read_points(*points, sides, out);
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
    for (const char* key : {"kind", "sense", "point", "direction", "dh"})
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
    if (row.has("point")) out.point = point(row, "point");
    if (const auto* direction = row.array("direction")) {
      out.direction.emplace();
      if (direction->size() != 3) row.refuse_key("direction", "X, Y and Z are needed", "", "direction = [0, 1, 1]");
      for (std::size_t i = 0; i < 3; ++i) // what is wrong already is not told again: as the letter
        (*out.direction)[i] =
            direction->size() == 3 ? read_number((*direction)[i], row.path("direction"), problems_).value_or(1) : 1;
    }
    if (row.has("dh") && row.has("modified_dh"))
      row.refuse_key("modified_dh", "the link is stated by dh, too", "the conventions differ", "leave one of them out");
    for (const char* key : {"dh", "modified_dh"})
      if (auto link = row.table(key)) out.link = read_link(*link, key == std::string("modified_dh"));
    row.refuse_unknown();
    return out;
  }

  chain::Link read_link(Table& table, bool modified) {
    table.declare(link_keys());
    const auto read = [&](const char* key, const char* si_unit) {
      return table.measure(key, {si_unit, units::Kind::difference}).value_or(0);
    };
    const chain::Link link{read("a", "m"), read("alpha", "rad"), read("d", "m"), read("theta", "rad"), modified};
    table.refuse_unknown();
    return link;
  }

  std::array<double, 3> point(Table& table, const std::string& key) {
    std::array<double, 3> out{};
    const auto* point = table.array(key);
    if (point && point->size() != 3)
      table.refuse_key(key, "X, Y and Z are needed", "", key + " = [\"0 mm\", \"0 mm\", \"-50 mm\"]");
    for (std::size_t i = 0; point && i < point->size() && point->size() == 3; ++i)
      out[i] = read_measure((*point)[i], table.path(key), {"m"}, problems_).value_or(0);
    return out;
  }

  /// Design points of a predefined machine's axes.
  void read_points(Table& table, bool sides, MachineDescription& out) {
    if (sides)
      return table.refuse("the axes are stated one by one", "each has its own point",
                          "write { axis = \"C\", point = [\"0 mm\", \"0 mm\", \"-50 mm\"] }");
    std::vector<std::string> names;
    for (auto* side : {&out.workpiece_side, &out.tool_side})
      if (*side)
        for (AxisDescription& a : **side) {
          names.push_back(a.name);
          if (table.has(a.name)) a.point = point(table, a.name);
        }
    for (const Member& m : table.members())
      if (!out.name.empty() && std::ranges::find(names, m.key) == names.end())
        table.refuse_key(m.key, fmt::format("the machine has no axis '{}'", m.key), "", did_you_mean(m.key, names));
  }

  void read_errors(Table& table, MachineDescription& out) {
    places_["errors"] = {&table.node(), table.path()};
    for (const Member& m : table.members()) {
      places_["errors." + m.key] = {&m.value, table.path(m.key)};
      const bool of_line = m.key.size() > 3 && m.key.starts_with("E_");
      const bool of_link = m.key.starts_with("delta_a_") || m.key.starts_with("delta_d_");
      const bool angle = (of_line && std::string_view("ABC").find(m.key[2]) != std::string_view::npos) ||
                         (!of_link && m.key.starts_with("delta_"));
      const bool length = (of_line && std::string_view("XYZ").find(m.key[2]) != std::string_view::npos) || of_link;
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
