#pragma once
/// Machines with two rotary axes, in the table, in the head, or one in each, by the few location errors that a measurement
/// between table and head can see. The slides are one block of translations between bed and table, or bed and head.
///
/// The first axis is displaced as a whole: a shift (x, y, z) and a rotation Rx Ry Rz about its point. The second one, against
/// the first, is shifted along and turned about the direction across both axes. With B and C in the table this is Ibaraki et
/// al. 2018, eq (8): Dx Dy Dz Da Db Dc Db(-B) Dx Da Dc(-C).
#include "chain/rotary_probing.h"

namespace gumshoe::chain {

/// A rotary axis, as it is designed.
struct RotaryPlace {
  int direction;             ///< 0, 1, 2: turns about X, Y, Z
  double sense;              ///< Axis::sense
  bool carries_workpiece;    ///< else the tool
  Vector3<double> point = {}; ///< on the axis, m
};

struct TwoRotaryAxes {
  RotaryPlace first, second; ///< from the bed; with one in each, the first is in the table
  /// Direction across both axes.
  constexpr int across() const { return 3 - first.direction - second.direction; }
  constexpr bool one_in_each() const { return first.carries_workpiece != second.carries_workpiece; }
};
/// B, and C on B, in the table.
inline constexpr TwoRotaryAxes table_BC{{1, -1, true}, {2, -1, true}};

/// Location errors, actual minus design. The shift along the first axis is a place of the second one.
template <class T> struct TwoRotaryErrors {
  Vector3<T> shift;    ///< m
  Vector3<T> rotation; ///< rad
  T offset, twist;     ///< of the second axis, along and about the direction across, m and rad
};

/// Right-handed rotation about X, Y or Z.
template <class T> Matrix3<T> turn_about(int direction, const T& angle) {
  const T c = num::cos(angle), s = num::sin(angle), zero(0.0), one(1.0);
  if (direction == 0) return {{one, zero, zero}, {zero, c, s}, {zero, -s, c}};
  if (direction == 1) return {{c, zero, -s}, {zero, one, zero}, {s, zero, c}};
  return {{c, s, zero}, {-s, c, zero}, {zero, zero, one}};
}
template <class T> Vector3<T> along(int direction, const T& length) {
  const T zero(0.0);
  return {direction == 0 ? length : zero, direction == 1 ? length : zero, direction == 2 ? length : zero};
}
template <class T> Vector3<T> point_of(const RotaryPlace& axis) {
  return {T(axis.point.x), T(axis.point.y), T(axis.point.z)};
}

/// A pose for each of the two axes.
template <class T> struct OfTwo { Pose<T> first, second; };

/// What the location errors do before each axis turns.
template <class T> OfTwo<T> located(const TwoRotaryAxes& axes, const TwoRotaryErrors<T>& e) {
  Vector3<T> first = e.shift, second = along(axes.across(), e.offset);
  if (axes.one_in_each()) { // the second axis stands on the bed and takes its own place
    const int own = axes.first.direction;
    const T moved = own == 0 ? e.shift.x : own == 1 ? e.shift.y : e.shift.z;
    first = first - along(own, moved), second = second + along(own, moved);
  }
  return {about(point_of<T>(axes.first), rotation(e.rotation.x, e.rotation.y, e.rotation.z), first),
          about(point_of<T>(axes.second), turn_about(axes.across(), e.twist), second)};
}

/// A pose at a commanded angle.
template <class T> Pose<T> turned(const RotaryPlace& axis, const T& command) {
  return about(point_of<T>(axis), turn_about(axis.direction, T(T(axis.sense) * command)));
}
/// With error motions, of the moving component, after the turn. Effects write them as those of B (first axis) or C
/// (second one); an axis of another direction takes them in its own frame, X, Y and Z exchanged cyclically.
/// @param written 1 for B, 2 for C
template <class T> Pose<T> turned(const RotaryPlace& axis, const T& command, const RotaryMotion<T>& motion, int written) {
  T error[E_X0];
  for (int i = 0; i < 3; ++i) {
    const int to = (i + axis.direction - written + 3) % 3;
    error[E_X + to] = motion.error[E_X + i], error[E_A + to] = motion.error[E_A + i];
  }
  const T zero(0.0), own = T(axis.sense) * command + error[E_A + axis.direction];
  error[E_A + axis.direction] = zero;
  const Matrix3<T> tilt = rotation(error[E_A], error[E_B], error[E_C]);
  return about(point_of<T>(axis), tilt * turn_about(axis.direction, own), {error[E_X], error[E_Y], error[E_Z]});
}

/// Poses of workpiece and tool against the bed, without the slides.
template <class T> struct Sides { Pose<T> workpiece, tool; };
template <class T> Sides<T> sides(const TwoRotaryAxes& axes, const Pose<T>& first, const Pose<T>& second) {
  if (axes.one_in_each()) return {first, second};
  if (axes.first.carries_workpiece) return {first * second, {}};
  return {{}, first * second};
}

} // namespace gumshoe::chain
