#pragma once
/// One reading of three laser ball bars: the bars from the sockets to the ball at the tool, and their lengths as read.
/// Source: Schmitz and Ziegert 1999, sections 2 and 3, appendix A.
#include "chain/ball_bar.h"
#include "models/laser_ball_bar/machine.h"
#include "models/laser_ball_bar/trilateration.h"

namespace gumshoe::models::laser_ball_bar {

/// Sockets at their present temperature.
template <class T> Sockets<T> sockets(const Rows::Quantities<T>& q) {
  const T growth = 1.0 + q.expansion * q.temperature_difference;
  return sockets<T>(growth * q.base_length_1, growth * q.base_length_2, growth * q.base_length_3);
}

template <class T> Vector3<T> z_motion(const Rows::Quantities<T>& q) { return {q.Z_motion_x, q.Z_motion_y, q.Z_motion_z}; }
template <class T> Vector3<T> x_motion(const Rows::Quantities<T>& q) { return {q.X_motion_x, q.X_motion_y, q.X_motion_z}; }
/// Turns coordinates along the machine's axes into those of the bars' frame: columns n_x, n_y, n_z (eq A1).
template <class T> Matrix3<T> bars_from_machine(const Rows::Quantities<T>& q) {
  const Vector3<T> n_z = normalised(z_motion(q)), n_y = normalised(cross(n_z, x_motion(q)));
  return {cross(n_y, n_z), n_y, n_z};
}

template <class T> Vector3<T> origin(const Rows::Quantities<T>& q) { return {q.origin_x, q.origin_y, q.origin_z}; }

/// Lengths of the bars with the ball at a point in the bars' frame, m.
template <class T> Distances<T> distances(const Sockets<T>& s, const Vector3<T>& ball) {
  return {length(from_socket(s, 0, ball)), length(from_socket(s, 1, ball)), length(from_socket(s, 2, ball))};
}

/// What the bars read of their lengths, and the inverse.
template <class T> class Bars {
public:
  Bars(const Rows::Quantities<T>& q, const Sockets<T>& sockets, const Moment<T>& now) : q_(q) {
    const auto short_by = [&](const T& along) {
      const T h2 = q.fixture_offset * q.fixture_offset;
      return h2 / (along + num::sqrt(along * along + h2));
    };
    const T fixture = short_by(q.fixture_length_12) + short_by(q.fixture_length_23);
    const auto turn = bars_from_machine(q);
    const Vector3<T> ball = turn * (origin(q) + now.tool + now.ball), velocity = turn * now.velocity;
    for (int i = 0; i < 3; ++i) {
      const Vector3<T> bar = from_socket(sockets, i, ball);
      chain::BallBar<T> as_read;
      as_read.speed = dot(bar, velocity) / length(bar);
      as_read.zero = of(Q::initialisation_1, i) + of(Q::form_1, i) - fixture;
      as_read.skew = of(Q::skew_1, i) + now.delay;
      error_[i] = chain::indication_error(as_read);
    }
  }
  Distances<T> read(const Distances<T>& l) const { return {read(0, l.to_1), read(1, l.to_2), read(2, l.to_3)}; }
  Distances<T> actual(const Distances<T>& l) const { return {actual(0, l.to_1), actual(1, l.to_2), actual(2, l.to_3)}; }

private:
  /// Value of bar i, 0 to 2, where three rows of the card, from `first`, hold one for each bar.
  const T& of(std::size_t first, int i) const { return array_of(q_)[first + static_cast<std::size_t>(i)]; }
  T read(int i, const T& length) const {
    const T& h = of(Q::axis_offset_1, i);
    return num::sqrt((length - h) * (length + h)) * (1.0 + q_.wavelength_error) + error_[i];
  }
  T actual(int i, const T& read) const {
    const T &h = of(Q::axis_offset_1, i), beam = (read - error_[i]) / (1.0 + q_.wavelength_error);
    return num::sqrt(beam * beam + h * h);
  }

  const Rows::Quantities<T>& q_;
  T error_[3];
};

template <class T>
Rows::Measurands<T> measurands(const Vector3<T>& from_socket_1, const At<T>& at) {
  const auto d = contour_of(at.c).deviation(from_socket_1 - origin(at.q), num::value(at.c.time));
  return {from_socket_1.x, from_socket_1.y, from_socket_1.z, d.normal, d.plane, d.following};
}

template <class T> Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>& outcome) {
  const auto now = moment(at);
  const auto base = sockets(at.q);
  const Vector3<T> tool = origin(at.q) + now.tool, ball = bars_from_machine(at.q) * (tool + now.ball);
  outcome.refuse(!(ball.z > T(0.0))); // the tool is not above the plane of the sockets
  const auto read = Bars<T>(at.q, base, now).read(distances(base, ball));
  return {{read.to_1, read.to_2, read.to_3}, measurands(tool, at)};
}

template <class T>
Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>& outcome) {
  if (at.evaluation == commanded) {
    const auto p = contour_of(at.c).commanded(num::value(at.c.time));
    const Vector3<T> tool = origin(at.q) + Vector3<T>{T(p.x), T(p.y), T(p.z)};
    return {tool.x, tool.y, tool.z, T(0.0), T(0.0), T(0.0)};
  }
  const auto now = moment(at);
  const auto base = sockets(at.q);
  const auto lengths = Bars<T>(at.q, base, now).actual({read.length_1, read.length_2, read.length_3});
  const Vector3<T> ball = trilaterate(base, lengths);
  outcome.refuse(!(ball.z >= T(0.0))); // no point has these distances from the three sockets
  return measurands<T>(transposed(bars_from_machine(at.q)) * ball - now.ball, at);
}

} // namespace gumshoe::models::laser_ball_bar
