#pragma once
/// A point that one or two rotary axes turn about a pivot: where it goes, and which errors of the angles take it to
/// where it was found. For the single socket method on three types of five-axis machines; corrected equations:
/// README.md of the model single_socket_rotation. Source: Wang et al. 2013, section 2.1.2.
#include "math/pose.h"

namespace gumshoe::chain {

/// The axes that turn the point. RTTTR has one in the head and one in the table, each with a point of its own.
enum class Turn { RRTTT, TTTRR, RTTTR_head, RTTTR_table };

/// Angles about X, Y and Z, or their errors, rad; 0 about an axis that the machine does not have.
template <class T> struct Angles { T alpha = T(0.0), beta = T(0.0), gamma = T(0.0); };
template <class T> Angles<T> operator+(const Angles<T>& a, const Angles<T>& b) {
  return {a.alpha + b.alpha, a.beta + b.beta, a.gamma + b.gamma};
}

/// The point from the pivot with all angles at 0, and how it is turned.
template <class T> struct TurnedPoint {
  Turn turn = Turn::RRTTT;
  Vector3<T> point;         ///< from the pivot, or TTTRR: from the centre of the turn by gamma, m
  T z_alpha_gamma = T(0.0); ///< TTTRR: that centre above the pivot of alpha, m
  Angles<T> commanded;
};

/// The place of a point from the pivot, m.
template <class T> Vector3<T> place(const TurnedPoint<T>& at, const Vector3<T>& point, const Angles<T>& by) {
  const T zero(0.0);
  const auto x = rotation(by.alpha, zero, zero);
  switch (at.turn) {
  case Turn::RRTTT:
    return x * (rotation(zero, by.beta, zero) * point);
  case Turn::TTTRR:
    return x * (rotation(zero, zero, by.gamma) * point + Vector3<T>{zero, zero, at.z_alpha_gamma});
  case Turn::RTTTR_head:
    return rotation(zero, by.beta, zero) * point;
  case Turn::RTTTR_table:
    break;
  }
  return x * point;
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
/// three equations, RTTTR one; NaN where no angle fulfils them.
///
/// - RRTTT: the direction of `found`; its length is not used
/// - TTTRR: the equation of X, then that of Y
/// - RTTTR: the direction of `found` square to the axis
template <class T> Angles<T> angle_errors(const TurnedPoint<T>& at, const Vector3<T>& found) {
  using detail::angle, detail::other_component;
  const T& alpha = at.commanded.alpha;
  TurnedPoint<T> inner = at; // with all but the turn about X
  inner.commanded.alpha = T(0.0);
  Vector3<T> p = place(inner, inner.commanded);
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
  p = rotation(alpha, T(0.0), T(0.0)) * p;
  error.alpha = angle(p.y, p.z, found.y, at.turn == Turn::TTTRR ? other_component(p.y, p.z, found.y) : found.z);
  return error;
}

/// The same to first order: eqs (6), (7), (17), (18), and (11), (12) corrected.
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
  // The source's point lies on the spindle; here it may lie beside it.
  TurnedPoint<T> inner = at;
  inner.commanded.alpha = T(0.0);
  Vector3<T> p = place(inner, inner.commanded);
  error.beta = (found.x - p.x) / p.z;
  p.z = p.z - error.beta * p.x;
  const Vector3<T> q = rotation(alpha, T(0.0), T(0.0)) * p;
  if (at.turn == Turn::RRTTT) error.alpha = (q.y * found.z - q.z * found.y) / (q.y * found.y + q.z * found.z);
  return error;
}

/// Length of the smallest lever by which an angle acts on the equations that are solved, m: 0 where they do not
/// determine the angles.
template <class T> T smallest_lever(const TurnedPoint<T>& at) {
  TurnedPoint<T> inner = at;
  inner.commanded.alpha = T(0.0);
  const Vector3<T> p = place(inner, inner.commanded), q = place(at, at.commanded);
  const auto less = [](const T& a, const T& b) { return T(0.5) * (a + b - num::abs(a - b)); };
  switch (at.turn) {
  case Turn::RRTTT:
    return less(num::abs(p.z), num::sqrt(q.y * q.y + q.z * q.z));
  case Turn::TTTRR:
    return less(num::abs(p.y), num::abs(q.z));
  case Turn::RTTTR_head:
    return num::sqrt(p.x * p.x + p.z * p.z);
  case Turn::RTTTR_table:
    break;
  }
  return num::sqrt(q.y * q.y + q.z * q.z);
}

} // namespace gumshoe::chain
