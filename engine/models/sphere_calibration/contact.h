#pragma once
/// Calibrating a probe and two rotary axes with a sphere, on a six-axis belt grinder.
///
/// The probe touches the top of a sphere at many angles B and C, and the control records the commands X, Y, Z. With the
/// tip's centre t above the sphere, the probe r from the commanded origin (probe.h) and the linear axes' errors e:
///     (X, Y, Z) = t - r(B + E_BB, C + E_CC) + e.
/// Source: Fang 2022, chapter 4, derived anew.
#include <optional>
#include <tuple>

#include "chain/rotary_probing.h"
#include "models/model.h"
#include "models/reading.h"
#include "models/sphere_calibration/card.h"
#include "models/sphere_calibration/closed_form.h"

namespace gumshoe::models::sphere_calibration {

/// The names of the card's rows. The first seven quantities are in the order of enum Length; to the middle four of
/// these the links are added.
struct Rows {
  GUMSHOE_NAMED(Quantities, probe_x, probe_y, probe_z, E_X0B, E_Z0B, E_X0C, E_Y0C, E_A0B, E_C0B, E_A0C, E_B0C, link_B_x,
                link_B_z, link_C_x, link_C_y, sphere_distance, sphere_radius, tip_radius, sphere_y, sphere_z, E_AA,
                E_BB, E_CC, E_XX, E_XY, E_XZ, E_YX, E_YY, E_YZ, E_ZX, E_ZY, E_ZZ, S_XY, S_XZ, S_YZ);
  GUMSHOE_NAMED(Conditions, A, B, C, pattern, repeat, direction, time, feed, B_direction, C_direction, B_clamped,
                C_clamped);
  GUMSHOE_NAMED(Indications, X, Y, Z);
  GUMSHOE_NAMED(Measurands, tip_x, tip_y, tip_z);
};
using Q = Rows::QuantitiesRow;
template <class T> using Quantities = Rows::Quantities<T>;
template <class T> using Conditions = Rows::Conditions<T>;
template <class T> using At = Reading<Rows, T>;

/// Actual lengths: the design distances and their errors (eqs 4.3 to 4.6).
template <class T> void actual_lengths(const Quantities<T>& quantities, T* length) {
  const T* q = array_of(quantities);
  for (int i = 0; i < lengths; ++i) length[i] = q[Q::probe_x + i];
  for (int i = 0; i < 4; ++i) length[length_B_x + i] = q[Q::link_B_x + i] + q[Q::E_X0B + i];
}

/// The machine behind the origin, the same at all readings of a sample that share these quantities.
template <class T> struct Links {
  T length[lengths];
  Orientation<T> tilted;
  Directions<T> lines;
};
/// The machine of these quantities.
template <class T> Links<T> links(const Quantities<T>& q) {
  Links<T> l;
  actual_lengths(q, l.length);
  l.tilted = {q.E_A0B, q.E_C0B, q.E_A0C, q.E_B0C};
  l.lines = directions(l.tilted);
  return l;
}

/// True if a reading is of pattern II (B moves at C = 90 deg), for the closed forms: according to its label `pattern`,
/// otherwise if B is not 0. A bool, or a mask of lanes.
template <class T> auto is_pattern_II(const Conditions<T>& c) {
  return (c.pattern == T(2.0)) || ((c.pattern != T(1.0)) && (c.B != T(0.0)));
}
/// Whether the closed form of its pattern exists at a reading.
template <class T> auto has_closed_form(const Conditions<T>& c) {
  const T right_angle(1.57079632679489661923), tolerance(1e-12);
  const auto second = is_pattern_II(c);
  return (second && (num::abs(c.C - right_angle) < tolerance)) || (!second && (num::abs(c.B) < tolerance));
}

/// One touch, along Z, as the stages of the measuring chain see it.
template <class T> struct Touch {
  chain::ProbingEvent<T> event;
  chain::RotaryProbing<T> rotary;

  Vector3<T> reading_of(const Vector3<T>& actual) const { return chain::reading_of(actual, event); }
  Vector3<T> actual_of(const Vector3<T>& reading) const { return chain::actual_of(reading, event); }
};
/// @param nominal commands by the quantities, without errors of positioning or effects, m
template <class T> Touch<T> touch(const Conditions<T>& c, const Vector3<T>& nominal, const Freed<T>& freed) {
  Touch<T> t;
  t.event.time = c.time;
  t.event.x.position = nominal.x, t.event.y.position = nominal.y, t.event.z.position = nominal.z;
  t.event.z.direction = c.direction;
  t.event.z.feed = c.feed;
  t.event.approach.z = c.direction;
  t.event.approach_in_probe = chain::approach_in_probe(c.direction, c.B, c.C);
  t.rotary.B.angle = c.B, t.rotary.C.angle = c.C;
  t.rotary.B.direction = c.B_direction, t.rotary.C.direction = c.C_direction;
  t.rotary.B.clamped = c.B_clamped, t.rotary.C.clamped = c.C_clamped;
  t.event.rotary = &t.rotary;
  freed.act(t.event);
  t.event.rotary = nullptr; // the touch may be copied
  return t;
}

/// Turns of B and C with error motions: about the axes' lines, then tilted; `shift` is what moves the lines, from the
/// origin. At null the turns are as they were, bit for bit.
template <class T> struct Moved {
  Matrix3<T> tilt_B, tilt_C;
  Vector3<T> shift_B, shift_C;
  Turns<T> turns;
  Vector3<T> shift() const { return shift_B + turns.b * shift_C; }
};
/// The turns of B and C with the error motions that effects added.
template <class T> Moved<T> moved(const Turns<T>& turns, const chain::RotaryProbing<T>& rotary) {
  const auto b = chain::error_motion(rotary.B.error, 1), c = chain::error_motion(rotary.C.error, 2);
  return {b.tilt, c.tilt, b.shift, c.shift, {b.tilt * turns.b, c.tilt * turns.c}};
}

/// The probe from the commanded origin at actual angles. @param pattern_II read by the closed form only  @param rotary
/// error motions, which the closed form has no place for; null: none
template <class T, class Mask>
Vector3<T> probe_from_origin(int variant, const Links<T>& l, const T& at_B, const T& at_C, const Mask& pattern_II,
                             const chain::RotaryProbing<T>* rotary = nullptr) {
  if (variant == closed_form)
    return choose(pattern_II, closed_form_II(l.length, l.tilted, at_B), closed_form_I(l.length, l.tilted, at_C));
  const Turns<T> turns =
      variant == small_angle ? small_angle_turns(l.tilted, at_B, at_C) : exact_turns(l.lines, at_B, at_C);
  if (!rotary) return probe_from_origin(l.length, turns);
  const Moved<T> m = moved(turns, *rotary);
  return probe_from_origin(l.length, m.turns) + m.shift();
}

/// The tip's centre at the trigger, from the commanded origin of the A axis' flange in machine axes: the top of the
/// sphere and the tip's radius. The sphere's centre stands at (-d_s, sphere_y, sphere_z), turned by A about +X
/// (eq 4.1). @param at_A actual angle, rad
template <class T> Vector3<T> tip_at_top(const Quantities<T>& q, const T& at_A) {
  const T c = num::cos(at_A), s = num::sin(at_A);
  return {-q.sphere_distance, q.sphere_y * c - q.sphere_z * s,
          q.sphere_y * s + q.sphere_z * c + (q.sphere_radius + q.tip_radius)};
}

/// Errors of the linear axes, added to the recorded commands, eq 4.51. @param y, z nominal commands, m
template <class T> Vector3<T> linear_errors(const Quantities<T>& q, const T& y, const T& z) {
  return {q.E_XX + q.E_XY + q.E_XZ + (q.S_XZ * z - q.S_XY * y), q.E_YX + q.E_YY + q.E_YZ - q.S_YZ * z,
          q.E_ZX + q.E_ZY + q.E_ZZ};
}

/// Whether a squareness error is not 0, in any lane: the closed forms have none.
template <class T> bool has_squareness(const Quantities<T>& q) {
  return num::any((q.S_XY != T(0.0)) || (q.S_XZ != T(0.0)) || (q.S_YZ != T(0.0)));
}

/// One contact with the sphere's top.
template <class T> struct Contact {
  Vector3<T> tip;                ///< tip_at_top
  Vector3<T> probe;              ///< r, at the actual angles
  Vector3<T> nominal;            ///< commands without positioning errors of A, B, C, without linear errors and effects
  Vector3<T> added;              ///< linear_errors
  std::optional<Touch<T>> touch; ///< only if effects act
};
/// @param squareness false: S_XY, S_XZ, S_YZ are all 0, and nominal commands are left at 0 unless effects act
template <class T> Contact<T> contact(const At<T>& reading, const Links<T>& l, bool squareness = true) {
  const auto& [q, c, freed] = std::tie(reading.q, reading.c, reading.freed);
  const int variant = is_joint(reading.evaluation) ? exact : reading.evaluation; // a joint evaluation stands on the exact chain
  const auto pattern_II = is_pattern_II(c);
  Contact<T> at;
  at.tip = tip_at_top(q, T(c.A + q.E_AA));
  if (squareness || freed.any()) at.nominal = tip_at_top(q, c.A) - probe_from_origin(variant, l, c.B, c.C, pattern_II);
  at.added = linear_errors(q, at.nominal.y, at.nominal.z);
  T at_B = c.B + q.E_BB, at_C = c.C + q.E_CC;
  if (!freed.any()) {
    at.probe = probe_from_origin(variant, l, at_B, at_C, pattern_II);
    return at;
  }
  at.touch = touch(c, at.nominal, freed);
  at_B = at_B + at.touch->rotary.B.error[chain::E_B], at_C = at_C + at.touch->rotary.C.error[chain::E_C];
  at.probe = probe_from_origin(variant, l, at_B, at_C, pattern_II, &at.touch->rotary);
  return at;
}
/// The same, with the machine behind the origin computed here.
template <class T> Contact<T> contact(const At<T>& reading) { return contact(reading, links(reading.q)); }

/// The commands that the control records.
template <class T> Vector3<T> simulate(const Contact<T>& at) {
  if (at.touch) return at.touch->reading_of(at.tip - at.probe) + at.added;
  return at.tip - at.probe + at.added;
}

/// Position of the tip's centre according to the recorded commands; the inverse of simulate.
template <class T> Vector3<T> evaluate(const Vector3<T>& recorded, const Contact<T>& at) {
  if (at.touch) return at.touch->actual_of(recorded - at.added) + at.probe;
  return recorded - at.added + at.probe;
}

/// The links of the previous reading, which most readings share.
template <class T> struct KnownLinks {
  T made_of[Q::link_C_y + 1];
  Links<T> links;
  bool known = false;
  const Links<T>& of(const Quantities<T>& quantities) {
    const T* q = array_of(quantities);
    if (known && num::derivative_levels<T> == 0) { // equal values may differ in their derivatives
      auto same = q[0] == made_of[0];
      for (std::size_t j = 1; j <= Q::link_C_y; ++j) same = same && (q[j] == made_of[j]);
      if (!num::any(!same)) return links;
    }
    for (std::size_t j = 0; j <= Q::link_C_y; ++j) made_of[j] = q[j];
    known = true;
    return links = sphere_calibration::links(quantities);
  }
};

} // namespace gumshoe::models::sphere_calibration
