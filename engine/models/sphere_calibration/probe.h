#pragma once
/// Position of the probe of the belt grinder from the commanded origin O_r, behind the rotary axes B (carried by Z) and
/// C (carried by B). Fang 2022, section 4.2.3, in any scalar.
///
/// The C axis' line passes through Dc = (D_rcx, D_rcy, 0), the B axis' line through Db = (D_rbx, 0, -D_rbz), the probe
/// stands at p = (probe_x, -probe_y, -probe_z), all from O_r at B = C = 0. With the turns Q about the actual axes,
///     r = Db + Qb ((Dc - Db) + Qc (p - Dc)),
/// linear in the seven lengths while the turns stay.
#include <array>

#include "chain/axis.h"

namespace gumshoe::models::sphere_calibration {

/// The lengths in the order of the model's quantities; actual distances D = link + E.
enum Length { length_probe_x, length_probe_y, length_probe_z, length_B_x, length_B_z, length_C_x, length_C_y, lengths };

/// Orientation errors of B and C, rad.
template <class T> struct Orientation { T A0B, C0B, A0C, B0C; };

/// Action of B and C on a vector: rotations, or nearly so in the small-angle product.
template <class T> struct Turns { Matrix3<T> b, c; };

/// Actual directions of the axes: chain::actual_direction.
template <class T> struct Directions { Vector3<T> b, c; };
template <class T> Directions<T> directions(const Orientation<T>& e) {
  const T b[] = {e.A0B, T(0.0), e.C0B}, c[] = {e.A0C, e.B0C, T(0.0)};
  return {chain::actual_direction(1, b), chain::actual_direction(2, c)};
}
/// Exact rotations about the actual axes. @param B, C actual angles, rad
template <class T> Turns<T> exact_turns(const Directions<T>& d, const T& B, const T& C) {
  return {rotation(d.b, B), rotation(d.c, C)};
}

/// The literal product (4.7) to (4.10): into the axis' frame and back by first-order matrices.
template <class T> Turns<T> small_angle_turns(const Orientation<T>& e, const T& B, const T& C) {
  const T one(1.0), zero(0.0);
  const Matrix3<T> b{{one, e.C0B, zero}, {-e.C0B, one, e.A0B}, {zero, -e.A0B, one}};
  const Matrix3<T> c{{one, zero, -e.B0C}, {zero, one, e.A0C}, {e.B0C, -e.A0C, one}};
  return {b * (rotation({zero, one, zero}, B) * transposed(b)), c * (rotation({zero, zero, one}, C) * transposed(c))};
}

/// The probe's centre from the commanded origin, r. @param length as enum Length, m
template <class T> Vector3<T> probe_from_origin(const T* length, const Turns<T>& q) {
  const Vector3<T> b{length[length_B_x], T(0.0), -length[length_B_z]},
      c{length[length_C_x], length[length_C_y], T(0.0)},
      p{length[length_probe_x], -length[length_probe_y], -length[length_probe_z]};
  return b + q.b * ((c - b) + q.c * (p - c));
}

/// The 3 x 7 matrix of r by the lengths, by columns: r = sum of length[i] column[i], and so its derivatives.
template <class T> std::array<Vector3<T>, lengths> probe_by_lengths(const Turns<T>& q) {
  const Matrix3<T> unit, probe = q.b * q.c;
  return {probe.x, -probe.y, -probe.z, unit.x - q.b.x, q.b.z - unit.z, q.b.x - probe.x, q.b.y - probe.y};
}

} // namespace gumshoe::models::sphere_calibration
