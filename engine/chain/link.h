#pragma once
/// A link of a robot by the parameters of Denavit and Hartenberg, in any scalar.
///
/// Two conventions are in use. The *standard* (distal) one, Denavit and Hartenberg 1955: the link's frame stands at its
/// far end, on the next joint's axis,
///     Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta),
/// the *modified* (proximal) one, Craig 1986: the frame stands on the link's own joint,
///     Tx(a) Rx(alpha) Ry(beta) Rz(theta) Tz(d).
/// The command of a rotary joint adds to theta, that of a linear one to d. beta is 0 by design: where two axes are
/// parallel, the four parameters jump when one of them tilts, and beta does not (Hayati and Mirmirani 1985).
#include "math/pose.h"

namespace gumshoe::chain {

/// Parameters by design, m and rad.
struct Link {
  double a = 0;     ///< length of the link, along X
  double alpha = 0; ///< twist of the link, about X
  double d = 0;     ///< offset along the joint's axis Z
  double theta = 0; ///< angle about the joint's axis Z at command 0
  bool modified = false;
};

/// Errors of the parameters, actual minus design, m or rad.
enum LinkError { link_a, link_alpha, link_d, link_theta, link_beta, link_errors };

namespace detail {

template <class T> Matrix3<T> twist(const Link& link, const T* e) {
  return rotation(T(link.alpha + e[link_alpha]), e[link_beta], T(0.0));
}

} // namespace detail

/// A point on the joint's axis, in the frame before the link.
template <class T> Vector3<T> joint_point(const Link& link, const T* e) {
  if (!link.modified) return {};
  return {link.a + e[link_a], T(0.0), T(0.0)};
}
/// Direction of the joint's axis, likewise.
template <class T> Vector3<T> joint_direction(const Link& link, const T* e) {
  if (!link.modified) return {T(0.0), T(0.0), T(1.0)};
  return detail::twist(link, e).z;
}

/// Pose of the link's frame in the frame before it.
/// @param command of the joint in its positive sense, rad if `rotary`, otherwise m
/// @param e       link_errors values
template <class T> Pose<T> motion(const Link& link, bool rotary, const T& command, const T* e) {
  T angle = link.theta + e[link_theta], offset = link.d + e[link_d];
  (rotary ? angle : offset) = (rotary ? angle : offset) + command;
  const Matrix3<T> turn = rotation(T(0.0), T(0.0), angle), twist = detail::twist(link, e);
  const T a = link.a + e[link_a];
  if (link.modified) return {twist * turn, Vector3<T>{a, T(0.0), T(0.0)} + offset * twist.z};
  return {turn * twist, a * turn.x + Vector3<T>{T(0.0), T(0.0), offset}};
}

} // namespace gumshoe::chain
