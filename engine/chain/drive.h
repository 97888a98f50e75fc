#pragma once
/// How an axis follows its command, and how gravity deflects it, in any scalar.
#include <span>

#include "chain/axis.h"

namespace gumshoe::chain {

/// Errors of an axis' drive and of the component that it moves; all 0 for a perfect axis.
enum DriveValue {
  drive_scale,      ///< relative: the axis moves by (1 + scale) times its command
  drive_cosine,     ///< of a rotary axis: error of the angle times cos(command), rad; an eccentric encoder's
  drive_sine,       ///< times sin(command), rad
  drive_compliance, ///< twist or shift per torque or force about or along the axis, rad/(N m) or m/N
  drive_mass,       ///< of the component, kg
  drive_centre_x,   ///< its centre of gravity in the component's frame, m
  drive_centre_y,
  drive_centre_z,
  drive_values
};
/// A linear axis has no first harmonic: its encoder does not turn with the command.
constexpr bool has_drive(const Axis& axis, int value) {
  return axis.rotary || (value != drive_cosine && value != drive_sine);
}

/// Where an axis goes at a command, without load: command (1 + scale) + cosine cos(command) + sine sin(command), m or
/// rad.
/// @param drive drive_values values
template <class T> T followed(const Axis& axis, const T& command, const T* drive) {
  const T scaled = command + drive[drive_scale] * command;
  if (!axis.rotary) return scaled;
  return scaled + (drive[drive_cosine] * num::cos(command) + drive[drive_sine] * num::sin(command));
}

/// Masses together, by their sum (kg) and first moment (kg m).
template <class T> struct Masses {
  T sum = T(0.0);
  Vector3<T> moment;
  void add(const T& mass, const Vector3<T>& at) { sum = sum + mass, moment = moment + mass * at; }
};

/// Twist (rad) or shift (m) of each axis under the weight of all that it carries, in the positive sense of its line:
/// compliance times the torque about the line or the force along it, to first order: in the pose without deflections.
/// @param axes    of one side of a machine, from the bed outwards
/// @param moved   pose of each against the one before, without deflections
/// @param errors  error_kinds values for each
/// @param drives  drive_values values for each
/// @param gravity acceleration in the frame of the bed, m/s^2
/// @param payload mass that the last component carries, kg, at the point `at` of its frame
/// @param before  room for one pose more than axes
/// @param out     one value for each axis
template <class T>
void deflections(std::span<const Axis> axes, const Pose<T>* moved, const T* errors, const T* drives,
                 const Vector3<T>& gravity, const T& payload, const Vector3<T>& at, Pose<T>* before, T* out) {
  const std::size_t n = axes.size();
  before[0] = {};
  for (std::size_t i = 0; i < n; ++i) before[i + 1] = before[i] * moved[i];
  Masses<T> carried;
  carried.add(payload, before[n] * at);
  for (std::size_t i = n; i-- > 0;) {
    const T* drive = drives + i * drive_values;
    const Vector3<T> centre{drive[drive_centre_x], drive[drive_centre_y], drive[drive_centre_z]};
    carried.add(drive[drive_mass], before[i + 1] * centre);
    const Line<T> line = actual_line(axes[i], errors + i * error_kinds);
    const Vector3<T> direction = before[i].turn * line.direction;
    const Vector3<T> arm = carried.moment - carried.sum * (before[i] * line.point); // kg m
    const T load = axes[i].rotary ? dot(direction, cross(arm, gravity)) : carried.sum * dot(direction, gravity);
    out[i] = drive[drive_compliance] * load;
  }
}

} // namespace gumshoe::chain
