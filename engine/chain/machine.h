#pragma once
/// Serial machine tools: any order of linear and rotary axes between bed and workpiece and between bed and tool, with
/// the ISO 230-1 and ISO 230-7 errors of every axis. An axis may be inclined, or a link by Denavit-Hartenberg
/// parameters.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chain/axis.h"

namespace gumshoe::chain {

/// An axis as a person states it.
struct AxisDescription {
  std::string name;              ///< X Y Z U V W linear, A B C rotary, J a link; a number may follow: "C2"
  std::string kind = {};         ///< "linear" or "rotary"; empty: as the letter says
  std::array<double, 3> point{}; ///< Axis::point, m
  int sense = 0;                 ///< Axis::sense; 0: by ISO 841, +1 on the tool side and -1 on the workpiece side
  /// Direction of an inclined axis (any length), within 90 deg of the axis its letter names; reached by the smallest rotation.
  std::optional<std::array<double, 3>> direction = {};
  std::optional<Link> link = {};
};

/// A machine as a person states it, right or wrong; `problems` tells.
struct MachineDescription {
  std::string name;
  /// From the bed outwards; {} where nothing moves, nullopt where not stated.
  std::optional<std::vector<AxisDescription>> workpiece_side, tool_side;
  std::vector<std::pair<std::string, double>> errors = {}; ///< by error_name, "E_A0C"; m or rad
};

/// Something wrong in a description. `place` names it as in a scenario: "tool_side[2].kind", "errors.E_A0D".
struct DescriptionProblem {
  std::string place, what, why, remedy;
};
/// Everything that is wrong with a description; empty if it makes a machine.
std::vector<DescriptionProblem> problems(const MachineDescription& description);

/// A machine by name; null if there is none.
///
/// - "grinder": the six-axis belt grinder of Fang 2022, chapter 4; its link lengths are inferred, not printed.
/// - "RRTTT", "TTTRR", "RTTTR": five-axis machines with two rotary axes in the head (A, B), two in the table (A, C) or
/// one
///   in each (B, A), all through the origin. Source: Wang et al. 2013.
const MachineDescription* find_machine(std::string_view name);
/// All machines that find_machine knows.
std::span<const MachineDescription> machines();

/// Name of an error of an axis by ISO 230-1 and ISO 230-7: "E_A0C"; of a link "delta_alpha_J1".
/// @param kind ErrorKind, of a link LinkError
std::string error_name(const Axis& axis, int kind);
/// True if an error is an angle, in rad; otherwise it is in m.
bool is_angle(const Axis& axis, int kind);

/// The first axis of a machine that is inclined or a link, in words: "the axis B is inclined"; empty if every axis is
/// along or about X, Y or Z.
std::string oblique(const class Machine& machine);

/// One error of one axis, and its place in the row of all errors of a machine.
struct ErrorPlace {
  std::size_t axis;
  int kind;
  std::size_t index() const { return axis * error_kinds + static_cast<std::size_t>(kind); }
};

/// A machine that can be computed.
///
/// Axes are numbered from the first of the workpiece side to the last of the tool side, each side from the bed
/// outwards. `commands` (one per axis, m or rad) and `errors` (error_kinds per axis, in the order of ErrorKind, m or
/// rad) stand in that order. Poses convert coordinates of the moving component's frame; with all axes at zero every
/// frame is the machine frame. The mathematics is in chain/README.md.
class Machine {
public:
  /// Throws InputError with every problem of the description.
  explicit Machine(const MachineDescription& description);

  std::span<const Axis> axes() const { return axes_; }
  std::size_t on_workpiece_side() const { return on_workpiece_side_; } ///< how many of them, the first ones
  std::span<const double> errors() const { return errors_; }           ///< as described
  /// Number of the axis of this name; SIZE_MAX if there is none.
  std::size_t axis(std::string_view name) const;
  /// Place of the error of this name, "E_A0C"; empty if the machine has no such error.
  std::optional<ErrorPlace> error(std::string_view name) const;

  /// Pose of the workpiece against the bed.
  template <class T> Pose<T> bed_from_workpiece(const T* commands, const T* errors) const {
    return along(0, on_workpiece_side_, commands, errors);
  }
  /// Pose of the tool (spindle) against the bed.
  template <class T> Pose<T> bed_from_tool(const T* commands, const T* errors) const {
    return along(on_workpiece_side_, axes_.size(), commands, errors);
  }
  /// Pose of the tool against the workpiece: what machining and probing depend on.
  template <class T> Pose<T> workpiece_from_tool(const T* commands, const T* errors) const {
    return inverse(bed_from_workpiece(commands, errors)) * bed_from_tool(commands, errors);
  }

private:
  std::vector<Axis> axes_;
  std::vector<double> errors_;
  std::size_t on_workpiece_side_ = 0;

  template <class T> Pose<T> along(std::size_t from, std::size_t to, const T* commands, const T* errors) const {
    Pose<T> pose;
    for (std::size_t i = from; i < to; ++i) pose = pose * motion(axes_[i], commands[i], errors + i * error_kinds);
    return pose;
  }
};

} // namespace gumshoe::chain
