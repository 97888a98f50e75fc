#include "chain/machine.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe::chain {
namespace {

constexpr std::string_view linear_letters = "XYZUVW", rotary_letters = "ABC", error_letters = "XYZABC";

/// 0 to 2, or nothing where the letter names no axis.
std::optional<int> direction_of(std::string_view name) {
  if (name.empty() || name.find_first_not_of("0123456789", 1) != std::string_view::npos) return std::nullopt;
  const auto linear = linear_letters.find(name[0]), rotary = rotary_letters.find(name[0]);
  if (linear != std::string_view::npos) return static_cast<int>(linear % 3);
  if (rotary != std::string_view::npos) return static_cast<int>(rotary);
  return std::nullopt;
}
bool rotary_by_letter(std::string_view name) { return rotary_letters.find(name[0]) != std::string_view::npos; }

/// "E_A0C" -> "A", location, "C". A number that begins with 0 is no axis, so "E_A0C" cannot be read otherwise.
struct ErrorName {
  int kind;
  std::string_view axis;
};
std::optional<ErrorName> parsed_error(std::string_view name) {
  if (!name.starts_with("E_") || name.size() < 4) return std::nullopt;
  const auto letter = error_letters.find(name[2]);
  if (letter == std::string_view::npos) return std::nullopt;
  const bool location = name[3] == '0';
  return ErrorName{static_cast<int>(letter) + (location ? E_X0 : 0), name.substr(location ? 4 : 3)};
}
Axis axis_of(const AxisDescription& d, bool on_tool_side) {
  return {d.name,
          direction_of(d.name).value_or(0),
          rotary_by_letter(d.name),
          d.sense != 0 ? static_cast<double>(d.sense) : (on_tool_side ? 1.0 : -1.0),
          {d.point[0], d.point[1], d.point[2]}};
}

void check_axis(const AxisDescription& a, const std::string& place, std::vector<std::string>& seen,
                std::vector<DescriptionProblem>& out) {
  if (!direction_of(a.name)) {
    out.push_back({place, "'" + a.name.substr(0, 40) + "' is not an axis",
                   "axes are X, Y, Z, U, V, W, A, B and C, optionally followed by a number", ""});
    return;
  }
  if (std::ranges::find(seen, a.name) != seen.end())
    out.push_back({place, "axis " + a.name + " is listed twice", "", "name the second one " + a.name + "2"});
  seen.push_back(a.name);
  const bool rotary = rotary_by_letter(a.name);
  const std::string_view kind = rotary ? "rotary" : "linear";
  if (!a.kind.empty() && a.kind != kind)
    out.push_back({place + ".kind", "axis " + a.name + " is " + std::string(kind) + ", not '" + a.kind + "'",
                   "X, Y, Z, U, V, W are linear axes, A, B, C rotary axes (ISO 841)", ""});
  if (a.sense < -1 || a.sense > 1)
    out.push_back({place + ".sense", "sense must be 1 or -1", "", "leave it out to follow ISO 841"});
  if (!std::ranges::all_of(a.point, [](double x) { return std::isfinite(x); }))
    out.push_back({place + ".point", "a coordinate is not finite", "", ""});
}

std::vector<Axis> axes_of(const MachineDescription& d) {
  std::vector<Axis> axes;
  for (const auto* side : {&d.workpiece_side, &d.tool_side})
    if (*side)
      for (const AxisDescription& a : **side)
        if (direction_of(a.name)) axes.push_back(axis_of(a, side == &d.tool_side));
  return axes;
}

std::optional<ErrorPlace> find_error(std::span<const Axis> axes, std::string_view name) {
  const auto parsed = parsed_error(name);
  if (!parsed) return std::nullopt;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].name == parsed->axis)
      return has_error(axes[i], parsed->kind) ? std::optional(ErrorPlace{i, parsed->kind}) : std::nullopt;
  return std::nullopt;
}

DescriptionProblem unknown_error(std::span<const Axis> axes, const std::string& name) {
  std::vector<std::string> known;
  for (const Axis& a : axes)
    for (int k = 0; k < error_kinds; ++k)
      if (has_error(a, k)) known.push_back(error_name(a, k));
  const auto parsed = parsed_error(name);
  std::string why =
      "a name is E_ with X, Y, Z, A, B or C, a 0 for a location error, and an axis: E_XZ, E_A0C (ISO 230-1)";
  if (parsed) {
    const auto axis = std::ranges::find(axes, parsed->axis, &Axis::name);
    why = axis == axes.end() ? fmt::format("the machine has no axis '{}'", parsed->axis.substr(0, 40))
          : axis->rotary     ? "a rotary axis has no offset along itself"
                             : "a linear axis has no offset and no orientation about itself";
  }
  const std::string meant = nearest(name, known);
  return {"errors." + name, "unknown error '" + name.substr(0, 40) + "'", why,
          meant.empty() ? "" : "did you mean '" + meant + "'?"};
}

} // namespace

std::string error_name(const Axis& axis, int kind) {
  return fmt::format("E_{}{}{}", error_letters[static_cast<std::size_t>(kind % E_X0)], kind < E_X0 ? "" : "0",
                     axis.name);
}

std::vector<DescriptionProblem> problems(const MachineDescription& d) {
  std::vector<DescriptionProblem> out;
  std::vector<std::string> seen;
  const auto check = [&](const char* name, const auto& side, const char* carried) {
    if (!side) {
      out.push_back({name, fmt::format("the machine has no {}", name),
                     fmt::format("this lists the axes from the bed to the {}", carried),
                     "write [] if nothing moves there"});
      return;
    }
    for (std::size_t i = 0; i < side->size(); ++i) check_axis((*side)[i], fmt::format("{}[{}]", name, i), seen, out);
  };
  check("workpiece_side", d.workpiece_side, "workpiece");
  check("tool_side", d.tool_side, "spindle");
  const auto axes = axes_of(d);
  if (d.workpiece_side && d.tool_side && d.workpiece_side->empty() && d.tool_side->empty())
    out.push_back({"", "the machine has no axes", "", ""});
  for (std::size_t i = 0; i < d.errors.size(); ++i) {
    const auto& [name, value] = d.errors[i];
    if (!find_error(axes, name)) {
      out.push_back(unknown_error(axes, name));
      continue;
    }
    if (!std::isfinite(value)) out.push_back({"errors." + name, "the value is not finite", "", ""});
    for (std::size_t j = 0; j < i; ++j)
      if (d.errors[j].first == name)
        out.push_back({"errors." + name, name + " is listed twice", "", "remove one of them"});
  }
  return out;
}

Machine::Machine(const MachineDescription& d) : axes_(axes_of(d)), errors_(axes_.size() * error_kinds, 0.0) {
  std::vector<Problem> wrong;
  for (const DescriptionProblem& p : problems(d))
    wrong.push_back({{}, "machine" + (p.place.empty() ? "" : "." + p.place) + ": " + p.what, p.why, p.remedy});
  if (!wrong.empty()) throw InputError(wrong);
  on_workpiece_side_ = d.workpiece_side->size();
  for (const auto& [name, value] : d.errors) errors_[error(name)->index()] = value;
}

std::size_t Machine::axis(std::string_view name) const {
  const auto it = std::ranges::find(axes_, name, &Axis::name);
  return it == axes_.end() ? SIZE_MAX : static_cast<std::size_t>(it - axes_.begin());
}

std::optional<ErrorPlace> Machine::error(std::string_view name) const { return find_error(axes_, name); }

std::span<const MachineDescription> machines() {
  using Axes = std::vector<AxisDescription>;
  // For the grinder, eq 4.1 turns the workpiece by +A although the text says -A; the links are inferred, none is
  // printed.
  static const std::vector<MachineDescription> table{
      {"grinder", Axes{{"X"}, {"A", "", {}, 1}},
       Axes{{"Y"}, {"Z"}, {"B", "", {-0.120, 0, -0.110}}, {"C", "", {0.050, 0.180, 0}}}},
      {"RRTTT", Axes{}, Axes{{"X"}, {"Y"}, {"Z"}, {"A"}, {"B"}}},
      {"TTTRR", Axes{{"A"}, {"C"}}, Axes{{"X"}, {"Y"}, {"Z"}}},
      {"RTTTR", Axes{{"A"}}, Axes{{"X"}, {"Y"}, {"Z"}, {"B"}}},
  };
  return table;
}

const MachineDescription* find_machine(std::string_view name) {
  const auto all = machines();
  const auto it = std::ranges::find(all, name, &MachineDescription::name);
  return it == all.end() ? nullptr : &*it;
}

} // namespace gumshoe::chain
