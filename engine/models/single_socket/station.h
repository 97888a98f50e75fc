#pragma once
/// One reading of the bar: from the ball's position error to the change of length, and the least squares that go back.
#include <vector>

#include "chain/ball_bar.h"
#include "models/model.h"
#include "models/single_socket/card.h"

namespace gumshoe::models::single_socket {

struct Rows {
  GUMSHOE_NAMED(Quantities, reference_x, reference_y, reference_z, bar_length, bar_zero, bar_expansion,
                temperature_difference, pivot_x, pivot_y, pivot_z, point_x, point_y, point_z, z_alpha_gamma, seating_x,
                seating_y, seating_z, nominal_x, nominal_y, nominal_z, position_error_x, position_error_y,
                position_error_z, d_alpha, d_beta, d_gamma);
  GUMSHOE_NAMED(Conditions, station_x, station_y, station_z, step, alpha, beta, gamma, direction, time, speed);
  GUMSHOE_NAMED(Indications, length_change);
  GUMSHOE_NAMED(Measurands, length_error);
};
template <class T> using At = Reading<Rows, T>;

/// A reading with what the bar and the slides do to it.
template <class T> struct Station {
  Vector3<T> lever;  ///< nominal, from the fixed ball to the moving one, m
  Vector3<T> slides; ///< errors of the slides that effects cause, m
  T nominal;         ///< length from which changes count, m
  T excess = T(0.0); ///< nominal distance of the balls less that, m
  chain::BallBar<T> bar;
};

template <class T> Station<T> station(const At<T>& at) {
  const auto& q = at.q;
  const Vector3<T> nominal{at.c.station_x, at.c.station_y, at.c.station_z};
  Station<T> s;
  s.lever = nominal - Vector3<T>{q.reference_x, q.reference_y, q.reference_z};
  const T distance = length(s.lever);
  s.nominal = num::select(q.bar_length > T(0.0), q.bar_length, distance);
  s.excess = distance - s.nominal;
  s.bar.length = s.nominal;
  s.bar.along = T(1.0) / distance * s.lever;
  s.bar.speed = at.c.speed;
  s.bar.zero = q.bar_zero;
  s.bar.growth = s.nominal * q.bar_expansion * q.temperature_difference;
  if (!at.freed.any()) return s;
  chain::ProbingEvent<T> event;
  const auto slide = [&](const T& position) {
    return chain::Slide<T>{.position = position, .direction = at.c.direction};
  };
  event.x = slide(nominal.x), event.y = slide(nominal.y), event.z = slide(nominal.z);
  event.time = at.c.time;
  event.bar = &s.bar;
  at.freed.act(event);
  const auto error = [](const chain::Slide<T>& x) { return x.position * x.scale + x.error; };
  s.slides = {error(event.x), error(event.y), error(event.z)};
  return s;
}

/// The balls' distance less `nominal` when the moving ball is `by` off its nominal place, m.
template <class T> T change_of_length(const Station<T>& s, const Vector3<T>& by) {
  const T more = s.excess * (T(2.0) * s.nominal + s.excess) + (T(2.0) * dot(s.lever, by) + dot(by, by));
  return more / (num::sqrt(s.nominal * s.nominal + more) + s.nominal);
}

/// Position error of the ball from changes of length at some stations.
template <class T> struct Position {
  Vector3<T> error; ///< m
  T residual_rms;   ///< m
  T amplification;
  T last_step; ///< by how much the last iteration changed the error, m
};
/// Least squares of the changes of length. Linear: eq (1), (P_i - P_0) D = l_i Delta_l_i, where l_i is the nominal
/// distance of the balls. Exact: Gauss-Newton, a fixed number of steps, so that a sample does not depend on its
/// neighbours.
template <class T>
Position<T> position_of(const std::vector<Station<T>>& stations, const std::vector<T>& changes, bool linear) {
  constexpr int exact_steps = 8, linear_steps = 2; // the second refines the rounding of the first
  Position<T> p;
  const T count(static_cast<double>(stations.size()));
  for (int k = 0; k < (linear ? linear_steps : exact_steps); ++k) {
    Matrix3<T> normal{{}, {}, {}};
    Vector3<T> right;
    T squares(0.0);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const Station<T>& s = stations[i];
      const Vector3<T> by = p.error + s.slides;
      const T distance = s.nominal + s.excess;
      const T change = linear ? s.excess + dot(s.lever, by) / distance : change_of_length(s, by);
      const Vector3<T> slope = linear ? T(1.0) / distance * s.lever : T(1.0) / (s.nominal + change) * (s.lever + by);
      const T left = changes[i] - change;
      normal = {normal.x + slope.x * slope, normal.y + slope.y * slope, normal.z + slope.z * slope};
      right = right + left * slope;
      squares = squares + left * left;
    }
    const Vector3<T> a = cross(normal.y, normal.z), b = cross(normal.z, normal.x), c = cross(normal.x, normal.y);
    const T one_by = T(1.0) / dot(normal.x, a); // of the determinant
    const Vector3<T> step = one_by * Vector3<T>{dot(a, right), dot(b, right), dot(c, right)};
    p.error = p.error + step;
    p.last_step = length(step);
    p.residual_rms = num::sqrt(squares / count);
    p.amplification = num::sqrt(one_by * (a.x + b.y + c.z) / T(3.0));
  }
  return p;
}

} // namespace gumshoe::models::single_socket
