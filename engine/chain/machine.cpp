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

/// A joint of a robot, "J1": what it is its link says.
bool is_joint(std::string_view name) {
  return name.starts_with('J') && name.find_first_not_of("0123456789", 1) == std::string_view::npos;
}
bool is_rotary(const AxisDescription& d) { return is_joint(d.name) ? d.kind != "linear" : rotary_by_letter(d.name); }
bool is_axis(const AxisDescription& d) { return direction_of(d.name) || (is_joint(d.name) && d.link); }

/// "E_A0C" -> the axis "C". A number that begins with 0 is no axis, so "E_A0C" cannot be read otherwise.
std::optional<std::string_view> axis_of_error(std::string_view name) {
  if (!name.starts_with("E_") || name.size() < 4 || error_letters.find(name[2]) == std::string_view::npos)
    return std::nullopt;
  return name.substr(name[3] == '0' ? 4 : 3);
}

/// The smallest rotation from the direction X, Y or Z to `to`.
Matrix3<double> inclination(int from, const std::array<double, 3>& to) {
  Vector3<double> letter;
  (from == 0 ? letter.x : from == 1 ? letter.y : letter.z) = 1;
  const auto wanted = normalised(Vector3<double>{to[0], to[1], to[2]});
  const auto across = cross(letter, wanted);
  const double sine = length(across);
  return sine == 0 ? Matrix3<double>{} : rotation(1 / sine * across, std::atan2(sine, dot(letter, wanted)));
}

Axis axis_of(const AxisDescription& d, bool on_tool_side) {
  const int direction = d.link ? 2 : direction_of(d.name).value_or(0);
  Axis axis{d.name,
            direction,
            is_rotary(d),
            d.sense != 0             ? static_cast<double>(d.sense)
            : on_tool_side || d.link ? 1.0
                                     : -1.0,
            {d.point[0], d.point[1], d.point[2]}};
  if (d.direction) axis.inclination = inclination(direction, *d.direction);
  axis.link = d.link;
  return axis;
}

/// Keys that only an inclined axis, a link or a plain axis may state.
void check_form(const AxisDescription& a, const std::string& place, std::vector<DescriptionProblem>& out) {
  const auto finite = [](const auto& values) {
    return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
  };
  if (!finite(a.point)) out.push_back({place + ".point", "a coordinate is not finite", "", ""});
  if (a.link) {
    if (!finite(std::array{a.link->a, a.link->alpha, a.link->d, a.link->theta}))
      out.push_back({place + ".dh", "a parameter is not finite", "", ""});
    if (a.direction || a.point != std::array<double, 3>{})
      out.push_back({place + (a.direction ? ".direction" : ".point"), "the axis is stated by dh, too",
                     "the parameters of the links say where it is", "leave one of them out"});
  } else if (a.direction && direction_of(a.name)) {
    const double along = (*a.direction)[static_cast<std::size_t>(*direction_of(a.name))];
    if (!finite(*a.direction) || !(along > 0))
      out.push_back({place + ".direction", "it points 90 deg or more away from the axis' letter",
                     "errors are named by the nearest of X, Y and Z, in its positive sense",
                     "choose another letter, or turn it round and write sense = -1"});
  }
}

void check_axis(const AxisDescription& a, const std::string& place, std::vector<std::string>& seen,
                std::vector<DescriptionProblem>& out) {
  if (!is_axis(a)) {
    const bool joint = is_joint(a.name);
    out.push_back({place, "'" + a.name.substr(0, 40) + "' is not an axis",
                   joint ? "J names a joint, which its link describes"
                         : "axes are X, Y, Z, U, V, W, A, B and C, and J for joints, optionally followed by a number",
                   joint ? "write dh = { a = \"0 mm\", alpha = \"90 deg\", d = \"89 mm\" }" : ""});
    return;
  }
  if (std::ranges::find(seen, a.name) != seen.end())
    out.push_back({place, "axis " + a.name + " is listed twice", "", "name the second one " + a.name + "2"});
  seen.push_back(a.name);
  const bool rotary = is_rotary(a);
  const std::string_view kind = rotary ? "rotary" : "linear";
  if (!a.kind.empty() && a.kind != kind)
    out.push_back({place + ".kind", "axis " + a.name + " is " + std::string(kind) + ", not '" + a.kind + "'",
                   "X, Y, Z, U, V, W are linear axes, A, B, C rotary axes (ISO 841)", ""});
  if (a.sense < -1 || a.sense > 1)
    out.push_back({place + ".sense", "sense must be 1 or -1", "", "leave it out to follow ISO 841"});
  check_form(a, place, out);
}

std::vector<Axis> axes_of(const MachineDescription& d) {
  std::vector<Axis> axes;
  for (const auto* side : {&d.workpiece_side, &d.tool_side})
    if (*side)
      for (const AxisDescription& a : **side)
        if (is_axis(a)) axes.push_back(axis_of(a, side == &d.tool_side));
  return axes;
}

std::optional<ErrorPlace> find_error(std::span<const Axis> axes, std::string_view name) {
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (int kind = 0; kind < error_kinds; ++kind)
      if (has_error(axes[i], kind) && error_name(axes[i], kind) == name) return ErrorPlace{i, kind};
  return std::nullopt;
}

DescriptionProblem unknown_error(std::span<const Axis> axes, const std::string& name) {
  std::vector<std::string> known;
  for (const Axis& a : axes)
    for (int k = 0; k < error_kinds; ++k)
      if (has_error(a, k)) known.push_back(error_name(a, k));
  const auto of = axis_of_error(name);
  std::string why =
      "a name is E_ with X, Y, Z, A, B or C, a 0 for a location error, and an axis: E_XZ, E_A0C (ISO 230-1)";
  if (of) {
    const auto axis = std::ranges::find(axes, *of, &Axis::name);
    why = axis == axes.end() ? fmt::format("the machine has no axis '{}'", of->substr(0, 40))
          : axis->link       ? "the errors of a link are delta_a, delta_alpha, delta_d, delta_theta and delta_beta"
          : axis->rotary     ? "a rotary axis has no offset along itself"
                             : "a linear axis has no offset and no orientation about itself";
  }
  const std::string meant = nearest(name, known);
  return {"errors." + name, "unknown error '" + name.substr(0, 40) + "'", why,
          meant.empty() ? "" : "did you mean '" + meant + "'?"};
}

} // namespace

std::string error_name(const Axis& axis, int kind) {
  static constexpr std::string_view of_link[] = {"a", "alpha", "d", "theta", "beta"};
  if (axis.link) return fmt::format("delta_{}_{}", of_link[static_cast<std::size_t>(kind)], axis.name);
  return fmt::format("E_{}{}{}", error_letters[static_cast<std::size_t>(kind % E_X0)], kind < E_X0 ? "" : "0",
                     axis.name);
}

bool is_angle(const Axis& axis, int kind) {
  if (axis.link) return kind != link_a && kind != link_d;
  return kind % E_X0 >= E_A;
}

std::string oblique(const Machine& machine) {
  for (const Axis& axis : machine.axes())
    if (axis.inclination || axis.link)
      return fmt::format("the axis {} is {}", axis.name, axis.link ? "a link" : "inclined");
  return {};
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
