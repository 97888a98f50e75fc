#pragma once
/// Serial machine tools: any order of linear and rotary axes between bed and workpiece and between bed and tool, with
/// the ISO 230-1 and ISO 230-7 errors of every axis.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chain/axis.h"

namespace gumshoe::chain {

struct AxisDescription {
  std::string name;              ///< X Y Z U V W linear, A B C rotary, a number may follow: "C2"
  std::string kind = {};         ///< "linear" or "rotary"; empty: as the letter says
  std::array<double, 3> point{}; ///< Axis::point, m
  int sense = 0;                 ///< Axis::sense; 0: by ISO 841, +1 on the tool side and -1 on the workpiece side
};

/// A machine as a person states it, right or wrong; `problems` tells.
struct MachineDescription {
  std::string name;
  /// From the bed outwards; {} where nothing moves, nullopt where not stated.
  std::optional<std::vector<AxisDescription>> workpiece_side, tool_side;
  std::vector<std::pair<std::string, double>> errors = {}; ///< by ISO name, "E_A0C"; m or rad
};

/// Something wrong at a place: "tool_side[2].kind", "errors.E_A0D".
struct DescriptionProblem {
  std::string place, what, why, remedy;
};
std::vector<DescriptionProblem> problems(const MachineDescription& description);

/// "grinder": the six-axis belt grinder of Fang 2022, its links inferred; "RRTTT", "TTTRR", "RTTTR": two rotary axes
/// in the head (A, B), two in the table (A, C), one in each (B, A), all through the origin (Wang 2013). Null if
/// unknown.
const MachineDescription* find_machine(std::string_view name);
std::span<const MachineDescription> machines();

/// "E_A0C": ISO's name of an error of an axis. @param kind ErrorKind
std::string error_name(const Axis& axis, int kind);

/// One error of one axis: a place in a row of errors.
struct ErrorPlace {
  std::size_t axis;
  int kind;
  std::size_t index() const { return axis * error_kinds + static_cast<std::size_t>(kind); }
};

/// A machine that can be computed. Axes count from the workpiece side's first to the tool side's last, each side from
/// the bed outwards; `commands` and `errors` (error_kinds per axis) stand in that order.
class Machine {
public:
  /// Throws InputError with every problem of the description.
  explicit Machine(const MachineDescription& description);

  std::span<const Axis> axes() const { return axes_; }
  std::size_t on_workpiece_side() const { return on_workpiece_side_; } ///< how many of them, the first ones
  std::span<const double> errors() const { return errors_; }           ///< as described
  /// SIZE_MAX if there is no such axis.
  std::size_t axis(std::string_view name) const;
  /// "E_A0C" -> its place, if the machine has such an error.
  std::optional<ErrorPlace> error(std::string_view name) const;

  template <class T> Pose<T> bed_from_workpiece(const T* commands, const T* errors) const {
    return along(0, on_workpiece_side_, commands, errors);
  }
  template <class T> Pose<T> bed_from_tool(const T* commands, const T* errors) const {
    return along(on_workpiece_side_, axes_.size(), commands, errors);
  }
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
