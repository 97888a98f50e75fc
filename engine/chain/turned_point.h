#pragma once
/// A point that one or two rotary axes turn about a pivot: where it goes, and which errors of the angles take it to
/// where it was found. For the single socket method on three types of five-axis machines, in closed form, and on others
/// (turned_by_two.h); corrected equations: README.md of the model single_socket_rotation. Source: Wang et al. 2013,
/// section 2.1.2.
#include <array>

#include "chain/turned_by_two.h"

namespace gumshoe::chain {

/// The axes that turn the point. RTTTR has one in the head and one in the table, each with a point of its own; those of
/// a described machine are stated.
enum class Turn { RRTTT, TTTRR, RTTTR_head, RTTTR_table, described };

/// Whether it turns about X, Y, Z. @param axes of a described machine
constexpr std::array<bool, 3> turns_about(Turn turn, const TwoRotaryAxes* axes = nullptr) {
  if (turn == Turn::described) return {axes->across() != 0, axes->across() != 1, axes->across() != 2};
  return {turn != Turn::RTTTR_head, turn == Turn::RRTTT || turn == Turn::RTTTR_head, turn == Turn::TTTRR};
}

/// The angles of those axes that there are, 0 else.
template <class T> Angles<T> only(const std::array<bool, 3>& about, const Angles<T>& a) {
  const T none(0.0);
  return {about[0] ? a.alpha : none, about[1] ? a.beta : none, about[2] ? a.gamma : none};
}

/// The point from the pivot with all angles at 0, and how it is turned.
template <class T> struct TurnedPoint {
  Turn turn = Turn::RRTTT;
  Vector3<T> point;         ///< from the pivot, or TTTRR: from the centre of the turn by gamma, m
  T z_alpha_gamma = T(0.0); ///< TTTRR: that centre above the pivot of alpha, m
  Angles<T> commanded;
  const TwoRotaryAxes* axes =
      nullptr; ///< of a described machine; `point` is from the second one's, the pivot the first one's

  /// Turn::described: z_alpha_gamma adds to the distance of the axes along Z.
  TurnedByTwo<T> by_two() const {
    const T zero(0.0);
    return {*axes, point_of<T>(axes->second) - point_of<T>(axes->first) + Vector3<T>{zero, zero, z_alpha_gamma}};
  }
};

/// Right-handed turns about X, Y and Z.
template <class T> Vector3<T> about_x(const T& angle, const Vector3<T>& v) {
  const T c = num::cos(angle), s = num::sin(angle);
  return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}
template <class T> Vector3<T> about_y(const T& angle, const Vector3<T>& v) {
  const T c = num::cos(angle), s = num::sin(angle);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}
template <class T> Vector3<T> about_z(const T& angle, const Vector3<T>& v) {
  const T c = num::cos(angle), s = num::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// The place of a point from the pivot before the turn about X, m.
template <class T>
Vector3<T> place_before_alpha(const TurnedPoint<T>& at, const Vector3<T>& point, const Angles<T>& by) {
  if (at.turn == Turn::RTTTR_table) return point;
  if (at.turn == Turn::TTTRR) return about_z(by.gamma, point) + Vector3<T>{T(0.0), T(0.0), at.z_alpha_gamma};
  return about_y(by.beta, point);
}
/// The place of a point from the pivot, m.
template <class T> Vector3<T> place(const TurnedPoint<T>& at, const Vector3<T>& point, const Angles<T>& by) {
  if (at.turn == Turn::described) return at.by_two().place(point, by);
  const Vector3<T> p = place_before_alpha(at, point, by);
  return at.turn == Turn::RTTTR_head ? p : about_x(by.alpha, p);
}
template <class T> Vector3<T> place(const TurnedPoint<T>& at, const Angles<T>& by) { return place(at, at.point, by); }

namespace detail {

/// Angle from the direction (c, s) to the direction (to_c, to_s).
template <class T> T angle(const T& c, const T& s, const T& to_c, const T& to_s) {
  return num::atan2(c * to_s - s * to_c, c * to_c + s * to_s);
}
/// The second component of a vector as long as (known, other) whose first one became `now`; on the side of `other`.
template <class T> T other_component(const T& known, const T& other, const T& now) {
  return other / num::abs(other) * num::sqrt(known * known + other * other - now * now);
}

} // namespace detail

/// Errors of the angles, exactly, of a point that was found at `found` from the pivot, m. Each type solves two of the
/// three equations, RTTTR one; NaN where no angle fulfils them. A described machine takes all three by least squares.
///
/// - RRTTT: the direction of `found`; its length is not used
/// - TTTRR: the equation of X, then that of Y
/// - RTTTR: the direction of `found` square to the axis
template <class T> Angles<T> angle_errors(const TurnedPoint<T>& at, const Vector3<T>& found) {
  using detail::angle, detail::other_component;
  if (at.turn == Turn::described) return at.by_two().errors(at.point, at.commanded, found);
  Vector3<T> p = place_before_alpha(at, at.point, at.commanded);
  Angles<T> error;
  if (at.turn == Turn::RRTTT) {
    p = num::sqrt(dot(found, found) / dot(p, p)) * p;
    const T z = other_component(p.x, p.z, found.x);
    error.beta = angle(p.z, p.x, z, found.x);
    p.z = z;
  }
  if (at.turn == Turn::TTTRR) {
    const T y = other_component(p.x, p.y, found.x);
    error.gamma = angle(p.x, p.y, found.x, y);
    p.y = y;
  }
  if (at.turn == Turn::RTTTR_head) {
    error.beta = angle(p.z, p.x, found.z, found.x);
    return error;
  }
  p = about_x(at.commanded.alpha, p);
  error.alpha = angle(p.y, p.z, found.y, at.turn == Turn::TTTRR ? other_component(p.y, p.z, found.y) : found.z);
  return error;
}

/// The same to first order, of the printed types: eqs (6), (7), (17), (18), and (11), (12) corrected.
template <class T> Angles<T> linear_angle_errors(const TurnedPoint<T>& at, const Vector3<T>& found) {
  const T &alpha = at.commanded.alpha, &gamma = at.commanded.gamma;
  const T ca = num::cos(alpha), sa = num::sin(alpha);
  Angles<T> error;
  if (at.turn == Turn::TTTRR) {
    const T cg = num::cos(gamma), sg = num::sin(gamma), w = at.point.z + at.z_alpha_gamma;
    const T u = at.point.x * cg - at.point.y * sg, v = at.point.x * sg + at.point.y * cg;
    const T k = at.point.x * at.point.x + at.point.y * at.point.y - found.x * u;
    error.gamma = (u - found.x) / v;
    error.alpha = (ca * k - (found.y + w * sa) * v) / (w * ca * v + sa * k);
    return error;
  }
  if (at.turn == Turn::RTTTR_table) {
    error.alpha = (at.point.y * ca - at.point.z * sa - found.y) / (at.point.z * ca + at.point.y * sa);
    return error;
  }
  // In the source the point is on the axis of the spindle; these equations hold for any point.
  Vector3<T> p = place_before_alpha(at, at.point, at.commanded);
  error.beta = (found.x - p.x) / p.z;
  p.z = p.z - error.beta * p.x;
  const Vector3<T> q = about_x(alpha, p);
  if (at.turn == Turn::RRTTT) error.alpha = (q.y * found.z - q.z * found.y) / (q.y * found.y + q.z * found.z);
  return error;
}

/// Length of the smallest lever by which an angle acts on the equations that are solved, m: 0 where they do not
/// determine the angles.
template <class T> T smallest_lever(const TurnedPoint<T>& at) {
  if (at.turn == Turn::described) return at.by_two().smallest_lever(at.point, at.commanded);
  const Vector3<T> p = place_before_alpha(at, at.point, at.commanded), q = about_x(at.commanded.alpha, p);
  const auto less = [](const T& a, const T& b) { return T(0.5) * (a + b - num::abs(a - b)); };
  switch (at.turn) {
  case Turn::RRTTT:
    return less(num::abs(p.z), num::sqrt(q.y * q.y + q.z * q.z));
  case Turn::TTTRR:
    return less(num::abs(p.y), num::abs(q.z));
  case Turn::RTTTR_head:
    return num::sqrt(p.x * p.x + p.z * p.z);
  case Turn::RTTTR_table:
  case Turn::described:
    break;
  }
  return num::sqrt(q.y * q.y + q.z * q.z);
}

} // namespace gumshoe::chain
