#pragma once
/// One point of a scan: where the beam of a displacement sensor meets the part on the table.
///
/// The slides carry the sensor over the commanded spot of the nominal surface, and it reads by how much the surface that
/// is there is nearer along the beam. The location errors of the axes move the beam, set-up errors the part.
/// Source: Ibaraki et al. 2018, sections 3 and 4, derived anew.
#include <tuple>

#include "chain/scanning.h"
#include "models/laser_scan/card.h"
#include "models/laser_scan/surfaces.h"
#include "models/model.h"

namespace gumshoe::models::laser_scan {

/// The names of the card's rows.
struct Rows {
  GUMSHOE_NAMED(Quantities, e_x, e_y, e_z, e_a, e_b, workpiece_x, workpiece_y, E_X0B, E_Y0C, E_Z0B, E_A0B, E_B0B, E_C0B,
                E_X0C_minus_E_X0B, E_A0C_minus_E_A0B, E_C0Y, E_A0Z, E_B0Z, sensor_length, sensor_zero, sensor_gain,
                cone_slope, cone_radius, cone_height, surface_height, plane_slope_x, plane_slope_y, cylinder_azimuth,
                surface_radius, ring_radius, profiles, form_deviation);
  GUMSHOE_NAMED(Conditions, B, C, radius, theta, surface, profile, time, direction, speed, B_direction, part_angle);
  GUMSHOE_NAMED(Indications, displacement);
  GUMSHOE_NAMED(Measurands, form_deviation);
};
template <class T> using Quantities = Rows::Quantities<T>;
template <class T> using At = Reading<Rows, T>;

/// What the readings of a sample share: the axes as they are located, and the part as it is set up.
template <class T> struct SetUp {
  chain::OfTwo<T> axes;
  Pose<T> part_from_table;
};
template <class T> SetUp<T> set_up(const At<T>& at) {
  const auto& q = at.q;
  const Vector3<T> centre{q.workpiece_x + q.e_x, q.workpiece_y + q.e_y, q.e_z};
  return {located<T>(axes_of(at.context), q), {chain::turn_about(0, T(-q.e_a)) * chain::turn_about(1, T(-q.e_b)), -centre}};
}

template <class T> Shape<T> shape(const Quantities<T>& q) {
  return {q.cone_slope,       q.cone_radius,    q.cone_height, q.surface_height, q.plane_slope_x, q.plane_slope_y,
          q.cylinder_azimuth, q.surface_radius, q.ring_radius};
}
/// f(surface, where it is that) for each surface that some lane has.
template <class T, class F> void for_each_surface(const At<T>& at, const F& f) {
  for (int s = 0; s < surfaces; ++s)
    if (const auto here = at.c.surface == T(s); num::any(here)) f(s, here);
}

/// Where the machine is commanded to.
template <class T> struct Command {
  Vector3<T> spot;        ///< on the nominal surface, in the table's frame
  chain::OfTwo<T> turns;  ///< of the two axes without errors
  Vector3<T> slides;      ///< X, Y, Z of the spindle's reference point
};
/// @param turned rad by which scan and second axis are ahead of the conditions
template <class T> Command<T> command(const At<T>& at, const T& turned) {
  const auto& q = at.q; // lambdas read them: a structured binding is not captured by clang 14
  const auto& c = at.c;
  const chain::TwoRotaryAxes& axes = axes_of(at.context);
  const T theta = c.theta + turned;
  const Vector3<T> on_part{c.radius * num::cos(theta), c.radius * num::sin(theta), T(0.0)};
  T height(0.0);
  for_each_surface(at, [&](int s, const auto& here) {
    height = num::select(here, height_over(s, shape(q), on_part, c.radius), height);
  });
  Command<T> out{{q.workpiece_x + on_part.x, q.workpiece_y + on_part.y, height},
                 {chain::turned(axes.first, c.B), chain::turned(axes.second, T(c.C + turned))}, {}};
  const auto sides = chain::sides(axes, out.turns.first, out.turns.second);
  out.slides = sides.workpiece * out.spot - sides.tool * Vector3<T>{T(0.0), T(0.0), -q.sensor_length};
  return out;
}

/// The beam in the part's frame, from where the commanded spot truly is.
/// @param slides actual  @param first, second turns of the axes, error motions included
template <class T>
Beam<T> beam(const At<T>& at, const SetUp<T>& set_up, const Vector3<T>& slides, const Pose<T>& first, const Pose<T>& second) {
  const T zero(0.0);
  const auto sides = chain::sides(axes_of(at.context), set_up.axes.first * first, set_up.axes.second * second);
  const Matrix3<T> to_table = transposed(sides.workpiece.turn);
  const Vector3<T> from = slides + sides.tool * Vector3<T>{zero, zero, -at.q.sensor_length};
  return {set_up.part_from_table * (to_table * (from - sides.workpiece.shift)),
          set_up.part_from_table.turn * (to_table * sides.tool.turn.z)};
}

/// Actual place of the slides, of which `moved` is the commanded one with errors of each slide.
template <class T> Vector3<T> squared(const Quantities<T>& q, const Vector3<T>& moved, const Vector3<T>& commanded) {
  return {moved.x - q.E_C0Y * commanded.y + q.E_B0Z * commanded.z, moved.y - q.E_A0Z * commanded.z, moved.z};
}

/// From the commanded spot along the beam to the surface that is there.
template <class T> T displacement(const At<T>& at, const Beam<T>& beam, Outcome<T>& outcome) {
  T t(0.0);
  for_each_surface(at, [&](int s, const auto& here) {
    const Shape<T> form = shape(at.q);
    Meeting<T> found{};
    if (s == torus) {
      Mask<T> converged;
      found = meet_torus(form, beam, converged);
      for (std::size_t i = 0; i < numbers_in<T>; ++i)
        if (holds_at(here && !converged, i)) outcome.fail(i, Status::not_converged);
    } else
      found = s == cone       ? meet_cone(form, beam)
              : s == plane    ? meet_plane(form, beam)
              : s == cylinder ? meet_cylinder(form, beam)
                              : meet_sphere(form, beam);
    outcome.refuse(here && found.behind_tip,
                   "the beam meets only the other nappe of the cone, beyond its tip, where the part has no surface");
    outcome.refuse(here && !found.there, "the beam misses the surface");
    t = num::select(here, found.t, t);
  });
  return t;
}

/// One reading: the displacement by the machine and the part's place, and what effects add to it.
template <class T> struct Spot {
  T displacement, form, error;
};
template <class T> Spot<T> spot(const At<T>& at, const SetUp<T>& set_up, Outcome<T>& outcome) {
  const T zero(0.0), one(1.0);
  const auto& q = at.q;
  const auto& c = at.c;
  const auto commanded = command(at, zero);
  outcome.refuse(!(commanded.spot.z == commanded.spot.z), "the surface does not reach as far as the commanded spot");
  const auto by_quantities = [&](const Command<T>& to) {
    return beam(at, set_up, squared(q, to.slides, to.slides), to.turns.first, to.turns.second);
  };
  Spot<T> out{displacement(at, by_quantities(commanded), outcome), zero, zero};
  if (!at.freed.any()) return out;

  chain::ProbingEvent<T> event;
  chain::RotaryProbing<T> rotary;
  chain::Scanning<T> scanning;
  event.time = c.time;
  event.x.position = commanded.slides.x, event.y.position = commanded.slides.y, event.z.position = commanded.slides.z;
  event.z.direction = -one; // lowered to the part
  rotary.B.angle = c.B, rotary.C.angle = c.C;
  rotary.B.direction = c.B_direction, rotary.C.direction = c.direction;
  const chain::TwoRotaryAxes& axes = axes_of(at.context);
  rotary.B.sense = T(axes.first.sense), rotary.C.sense = T(axes.second.sense);
  scanning.azimuth = c.theta, scanning.part_angle = c.part_angle;
  scanning.turn_rate = c.direction * c.speed, scanning.displacement = out.displacement;
  rotary.B.clamped = one, rotary.C.clamped = num::select(scanning.turn_rate == zero, one, zero); // clamped at rest
  event.rotary = &rotary, event.scanning = &scanning;
  at.freed.act(event);

  const T ahead = scanning.turn_rate * scanning.skew;
  const auto then = command(at, ahead);
  const Vector3<T> moved{chain::actual_of(then.slides.x, event.x, zero), chain::actual_of(then.slides.y, event.y, zero),
                         chain::actual_of(then.slides.z, event.z, zero)};
  const Beam<T> real = beam(at, set_up, squared(q, moved, then.slides), chain::turned(axes.first, c.B, rotary.B, 1),
                            chain::turned(axes.second, T(c.C + ahead), rotary.C, 2));
  out.displacement = displacement(at, real, outcome);
  out.form = scanning.form, out.error = scanning.error;
  return out;
}

/// The set-up of the previous reading, which most readings share.
template <class T> struct KnownSetUp {
  static constexpr std::size_t read = Rows::QuantitiesRow::E_A0C_minus_E_A0B + 1; ///< quantities of a set-up, the first ones
  T made_of[read];
  SetUp<T> kept;
  bool known = false;
  const SetUp<T>& of(const At<T>& at) {
    const T* q = array_of(at.q);
    if (known && num::derivative_levels<T> == 0) { // equal values may differ in their derivatives
      auto same = q[0] == made_of[0];
      for (std::size_t j = 1; j < read; ++j) same = same && (q[j] == made_of[j]);
      if (!num::any(!same)) return kept;
    }
    for (std::size_t j = 0; j < read; ++j) made_of[j] = q[j];
    known = true;
    return kept = set_up(at);
  }
};

/// What the sensor shows of a surface that stands nearer than nominal by `form_deviation`, and the inverse.
template <class T> T indication(const At<T>& at, const Spot<T>& spot, const T& form_deviation) {
  return at.q.sensor_zero + (1.0 + at.q.sensor_gain) * (spot.displacement + spot.form + form_deviation) + spot.error;
}
template <class T> T form_deviation(const At<T>& at, const Spot<T>& spot, const T& indication) {
  return (indication - spot.error - at.q.sensor_zero) / (1.0 + at.q.sensor_gain) - spot.form - spot.displacement;
}

} // namespace gumshoe::models::laser_scan
