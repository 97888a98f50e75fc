#pragma once
/// One axis of a machine and its errors by ISO 230-1 and ISO 230-7, in any scalar.
///
/// Errors are actual minus commanded, of the moving component, in the right-handed machine frame. E_X0C: location (of
/// the axis' average line) and zero position; E_XC: error motion, at the commanded position.
#include <optional>
#include <string>

#include "chain/link.h"

namespace gumshoe::chain {

/// The errors of an axis: error motions along X, Y, Z (m) and about X, Y, Z (rad), then location errors in the same
/// order.
enum ErrorKind { E_X, E_Y, E_Z, E_A, E_B, E_C, E_X0, E_Y0, E_Z0, E_A0, E_B0, E_C0, error_kinds };

/// One axis, as it is designed.
struct Axis {
  std::string name;  ///< "X", "C", "C2", of a link "J1"
  int direction = 0; ///< 0, 1, 2: moves along, or turns about, X, Y, Z; of a link its own Z
  bool rotary = false;
  double sense = 1;        ///< of the component's motion at a positive command: -1 if it carries the workpiece
  Vector3<double> point{}; ///< a design point on a rotary axis; of a linear one, where its angular errors act; m
  /// Rotation of an inclined axis about its point, from the direction of its letter; its errors are turned with it.
  std::optional<Matrix3<double>> inclination = {};
  std::optional<Link> link = {}; ///< stated by Denavit-Hartenberg parameters; its errors are LinkError
};

/// True if ISO 230-1 defines this error for such an axis. A rotary axis has no location error along its own line, a
/// slide none across its direction and no angular one about it. A link has the errors of its parameters.
constexpr bool has_error(const Axis& axis, int kind) {
  if (axis.link) return kind >= 0 && kind < link_errors;
  if (kind < E_X0) return kind >= 0;
  if (kind < E_A0) return axis.rotary != (kind - E_X0 == axis.direction);
  return kind < error_kinds && (axis.rotary || kind - E_A0 != axis.direction);
}

/// Actual direction of the axis average line, a unit vector, from its design direction and its two orientation errors:
///     c ~ (tan E_B0C, -tan E_A0C, 1),  b ~ (-tan E_C0B, 1, tan E_A0B),  a ~ (1, tan E_C0A, -tan E_B0A)
/// Other parametrisations differ in second order.
/// @param direction   0, 1, 2: X, Y, Z
/// @param orientation E_A0, E_B0, E_C0, rad, below pi/2; the one about the axis itself is not read
template <class T> Vector3<T> actual_direction(int direction, const T* orientation) {
  const auto slope = [&](int i) { return num::sin(orientation[i]) / num::cos(orientation[i]); };
  switch (direction) {
  case 0:
    return normalised(Vector3<T>{T(1.0), slope(2), -slope(1)});
  case 1:
    return normalised(Vector3<T>{-slope(2), T(1.0), slope(0)});
  default:
    return normalised(Vector3<T>{slope(1), -slope(0), T(1.0)});
  }
}

/// The line along or about which an axis moves its component, in coordinates of the component that carries it.
template <class T> struct Line {
  Vector3<T> point;     ///< on it, m
  Vector3<T> direction; ///< unit vector
};
/// Actual line of an axis.
/// @param e error_kinds values, m or rad
template <class T> Line<T> actual_line(const Axis& axis, const T* e) {
  if (axis.link) return {joint_point(*axis.link, e), joint_direction(*axis.link, e)};
  Line<T> line{{T(0.0), T(0.0), T(0.0)}, actual_direction(axis.direction, e + E_A0)};
  if (axis.rotary) line.point = Vector3<T>{e[E_X0], e[E_Y0], e[E_Z0]};
  if (axis.inclination) {
    const Matrix3<T> turned = constant<T>(*axis.inclination);
    line = {turned * line.point, turned * line.direction};
  }
  line.point = constant<T>(axis.point) + line.point;
  return line;
}

namespace detail {

/// An axis along or about X, Y or Z, whose design point is `design`.
template <class T> Pose<T> motion_by_letter(const Axis& axis, const Vector3<T>& design, const T& command, const T* e) {
  Vector3<T> point = design, travel{e[E_X], e[E_Y], e[E_Z]};
  const Vector3<T> line = actual_direction(axis.direction, e + E_A0);
  const int d = axis.direction;
  if (!axis.rotary)
    return about(point, rotation(e[E_A], e[E_B], e[E_C]), travel + (axis.sense * command + e[E_X0 + d]) * line);
  point = point + Vector3<T>{e[E_X0], e[E_Y0], e[E_Z0]};
  const T own = axis.sense * command + e[E_A0 + d] + e[E_A + d]; // all three about the same line
  const T zero(0.0);
  const Matrix3<T> tilt = rotation(d == 0 ? zero : e[E_A], d == 1 ? zero : e[E_B], d == 2 ? zero : e[E_C]);
  return about(point, tilt * rotation(line, own), travel);
}

} // namespace detail

/// Pose of a component against the one that carries it, in coordinates of the machine frame at zero position; of a
/// link, its frame against the frame before it.
///
/// First the exact motion along or about the actual line, then the error motions: a rotation Rx Ry Rz by the three
/// angular ones about the axis' point, as moved, and a shift by the three linear ones, all along the machine's axes; of
/// an inclined axis, along these turned with it.
/// @param command m or rad
/// @param e       error_kinds values, m or rad; of a link, its first link_errors
template <class T> Pose<T> motion(const Axis& axis, const T& command, const T* e) {
  if (axis.link) return motion(*axis.link, axis.rotary, T(axis.sense * command), e);
  const Vector3<T> point = constant<T>(axis.point);
  if (!axis.inclination) return detail::motion_by_letter(axis, point, command, e);
  const Matrix3<T> turned = constant<T>(*axis.inclination);
  const Pose<T> upright = detail::motion_by_letter(axis, {T(0.0), T(0.0), T(0.0)}, command, e);
  return about(point, turned * upright.turn * transposed(turned), turned * upright.shift);
}

} // namespace gumshoe::chain
