#pragma once
/// The machine at the moment of a reading: rotary axes that stand, slides that follow a contour, and the tool on the table.
#include <algorithm>
#include <cmath>

#include "chain/contour.h"
#include "chain/contouring.h"
#include "models/laser_ball_bar/card.h"
#include "models/model.h"
#include "models/reading.h"

namespace gumshoe::models::laser_ball_bar {

/// The names of the card's rows.
struct Rows {
  GUMSHOE_NAMED(Quantities, base_length_1, base_length_2, base_length_3, Z_motion_x, Z_motion_y, Z_motion_z, X_motion_x,
                X_motion_y, X_motion_z, origin_x, origin_y, origin_z, initialisation_1, initialisation_2,
                initialisation_3, fixture_length_12, fixture_length_23, fixture_offset, form_1, form_2, form_3,
                axis_offset_1, axis_offset_2, axis_offset_3, wavelength_error, expansion, temperature_difference, skew_1,
                skew_2, skew_3, loop_gain, damping, tool_length, E_X0B, E_Y0C, E_Z0B, E_A0B, E_B0B, E_C0B,
                E_X0C_minus_E_X0B, E_A0C_minus_E_A0B);
  GUMSHOE_NAMED(Conditions, contour, x, y, z, size, angle, elevation, sense, feed, acceleration, jerk, order, time,
                contour_start, settling, motion, sides, dwell, turns, rise, B, C);
  GUMSHOE_NAMED(Indications, length_1, length_2, length_3);
  GUMSHOE_NAMED(Measurands, tool_x, tool_y, tool_z, contour_error, plane_error, following_error);
};
using Q = Rows::QuantitiesRow;
template <class T> using At = Reading<Rows, T>;

inline constexpr double settled = 1; ///< s after a contour's end at which the slides have come to rest

/// The contour of the tool on the table.
template <class T> chain::Contour contour_of(const Rows::Conditions<T>& c) {
  const auto value = [](const T& x) { return num::value(x); };
  return {static_cast<chain::ContourKind>(static_cast<int>(value(c.contour))),
          {value(c.x), value(c.y), value(c.z)},
          {value(c.angle), value(c.elevation)},
          value(c.size),
          value(c.sense),
          value(c.feed),
          value(c.acceleration),
          value(c.jerk),
          {static_cast<int>(value(c.sides)), value(c.dwell)},
          {value(c.turns), value(c.rise)}};
}

/// The rotary axes, which stand while the slides carry the tool along its contour on the table. The frame of the bars was
/// measured at angles 0, where table and tool thus are where they should be: location errors say where the axes are then.
template <class T> class Standing {
public:
  explicit Standing(const At<T>& at) {
    const T zero(0.0), &l = at.q.tool_length;
    slides_.z = l, tool_.z = -l;
    if (all_zero(at)) return; // the same numbers as below
    const chain::TwoRotaryAxes& axes = axes_of(at.context);
    const auto commanded = chain::sides(axes, chain::turned<double>(axes.first, num::value(at.c.B)),
                                        chain::turned<double>(axes.second, num::value(at.c.C)));
    to_bed_ = commanded.workpiece.turn;
    // Commanded, the tool at `tool_length` below the spindle's reference point is on its contour.
    const Vector3<double> table = commanded.workpiece.shift - commanded.tool.shift, spindle = commanded.tool.turn.z;
    slides_ = Vector3<T>{T(table.x), T(table.y), T(table.z)} + Vector3<T>{spindle.x * l, spindle.y * l, spindle.z * l};
    const auto located = models::located<T>(axes, at.q);
    const auto at_zero = chain::sides(axes, located.first, located.second);
    const auto actual = chain::sides(axes, located.first * chain::turned<T>(axes.first, at.c.B),
                                     located.second * chain::turned<T>(axes.second, at.c.C));
    to_table_ = at_zero.workpiece * inverse(actual.workpiece);
    tool_ = (actual.tool * inverse(at_zero.tool)) * Vector3<T>{zero, zero, -l};
  }
  /// Turns a contour on the table into what the slides follow, up to slides().
  const Matrix3<double>& to_bed() const { return to_bed_; }
  const Vector3<T>& slides() const { return slides_; }
  /// Where the tool is on the table when the slides are there, m.
  Vector3<T> tool(const Vector3<T>& slides) const { return to_table_ * (slides + tool_); }
  /// A direction of the machine as seen from the table.
  Vector3<T> on_table(const Vector3<T>& direction) const { return to_table_.turn * direction; }

private:
  /// Whether neither angle nor error turns or moves an axis, in no derivative either.
  static bool all_zero(const At<T>& at) {
    bool zero = is_zero(at.c.B) && is_zero(at.c.C);
    for (std::size_t j = Q::E_X0B; j <= Q::E_A0C_minus_E_A0B; ++j) zero = zero && is_zero(array_of(at.q)[j]);
    return zero;
  }
  static bool is_zero(double x) { return x == 0; }
  template <class R, int N> static bool is_zero(const Dual<R, N>& x) {
    return is_zero(x.v) && std::ranges::all_of(x.d, [](const R& d) { return is_zero(d); });
  }

  Matrix3<double> to_bed_;
  Pose<T> to_table_;
  Vector3<T> slides_, tool_;
};

/// The machine at the moment of a reading, as the quantities and the freed effects predict it.
template <class T> struct Moment {
  Vector3<T> slides, tool, velocity; ///< places of slides, m; of the tool on the table, m and m/s
  Vector3<T> ball;                   ///< of the ball that the bars meet, from the tool: the bracket gives way, m
  T delay = T(0.0);                  ///< of reading all bars, s
};
template <class T> Moment<T> moment(const At<T>& at) {
  const Standing<T> standing(at);
  chain::Contour contour = contour_of(at.c);
  contour.turn(standing.to_bed());
  const double time = num::value(at.c.time);
  const int order = static_cast<int>(num::value(at.c.order));
  const auto servo = [&](const T& gain_error) {
    return chain::Servo<T>(order, at.q.loop_gain * (1.0 + gain_error), at.q.damping);
  };
  const auto moment = [&](const Vector3<T>& slides, const Vector3<T>& velocity) {
    return Moment<T>{slides, standing.tool(slides), standing.on_table(velocity), {}};
  };
  const auto predicted = contour.follow(servo(T(0.0)), time);
  const Vector3<T> p = predicted.position + standing.slides();
  if (!at.freed.any()) return moment(p, predicted.velocity);

  chain::Contouring<T> contouring;
  chain::ProbingEvent<T> event;
  event.contouring = &contouring;
  event.time = at.c.contour_start + at.c.time;
  // The axis turns round when its command has done so, later by the lag.
  const T lag = 1.0 / at.q.loop_gain;
  const auto slide = [&](int i, const T& position, const T& velocity, chain::Slide<T>& s, chain::Following<T>& f) {
    const auto side = contour.direction(i, time - num::value(lag));
    s.position = position, s.direction = T(side.sign), s.feed = num::abs(velocity);
    if (side.reversed >= 0) f.since_reversal = (time - side.reversed) - lag;
  };
  const auto& v = predicted.velocity;
  slide(0, p.x, v.x, event.x, contouring.x), slide(1, p.y, v.y, event.y, contouring.y);
  slide(2, p.z, v.z, event.z, contouring.z);
  at.freed.act(event);

  const chain::Servo<T> servos[] = {servo(contouring.x.gain_error), servo(contouring.y.gain_error),
                                    servo(contouring.z.gain_error)};
  const auto actual = [](const T& x, const chain::Slide<T>& s) { return x * (1.0 + s.scale) + s.error; };
  const auto moved = contour.follow(servos, time);
  const Vector3<T> to = moved.position + standing.slides();
  auto now = moment({actual(to.x, event.x), actual(to.y, event.y), actual(to.z, event.z)}, moved.velocity);
  now.ball = standing.on_table(-contouring.compliance * moved.acceleration);
  now.delay = contouring.delay;
  return now;
}

} // namespace gumshoe::models::laser_ball_bar
