#pragma once
/// A commanded contour, and slides X, Y, Z whose servos follow it. What is commanded is exact: plain doubles in SI.
#include <numbers>
#include <optional>

#include "chain/servo.h"
#include "math/pose.h"

namespace gumshoe::chain {

/// A point at which the slides stand; a line from there; a full circle about it, from where its plane's first direction
/// points.
enum class ContourKind { point, line, circle };

/// The plane of a contour: `along` has the azimuth `angle` from +X towards +Y and rises by `elevation`; `left` is
/// horizontal; `up` is square to both.
struct ContourPlane {
  Vector3<double> along, left, up;
  ContourPlane(double angle, double elevation) {
    const double c = num::cos(angle), s = num::sin(angle), ce = num::cos(elevation), se = num::sin(elevation);
    along = {c * ce, s * ce, se}, left = {-s, c, 0.0}, up = {-(c * se), -(s * se), ce};
  }
};

/// A point by its distance from the contour.
template <class T> struct ContourDeviation {
  T normal;    ///< in the contour's plane: to the left of a line's direction, outwards from a circle; m
  T plane;     ///< out of the plane, along `up`, m
  T following; ///< how far the commanded point is ahead, along the contour, m
};

class Contour {
public:
  /// @param size   length of a line, radius of a circle, m, positive; not read for a point
  /// @param sense  of a circle in its plane: 1 from `along` towards `left` (counter-clockwise from above), or -1
  Contour(ContourKind kind, const Vector3<double>& place, const ContourPlane& plane, double size, double sense,
          double feed, double acceleration, double jerk)
      : kind_(kind), place_(place), plane_(plane), size_(size), sense_(sense) {
    if (kind != ContourKind::point)
      move_.emplace(kind == ContourKind::circle ? 2 * std::numbers::pi * size : size, feed, acceleration, jerk);
  }

  /// Null for a point.
  const FeedProfile* move() const { return move_ ? &*move_ : nullptr; }
  /// Commanded angle round a circle from its start, rad; positive in the circle's sense.
  double angle(double t) const { return move_ ? move_->path(t) / size_ : 0; }

  /// The commanded point.
  Vector3<double> commanded(double t) const {
    if (!move_) return place_;
    if (kind_ == ContourKind::line) return place_ + move_->path(t) * plane_.along;
    return place_ + size_ * (num::cos(angle(t)) * plane_.along + sense_ * num::sin(angle(t)) * plane_.left);
  }

  /// Motion of the slides at time t: servo[i] moves slide i.
  template <class T> Motion<Vector3<T>> follow(const Servo<T> (&servo)[3], double t) const {
    Motion<T> slide[3];
    for (int i = 0; i < 3; ++i) slide[i] = follow(servo[i], i, t);
    return together(slide);
  }
  /// The same with one servo for all.
  template <class T> Motion<Vector3<T>> follow(const Servo<T>& servo, double t) const {
    Motion<T> slide[3];
    if (kind_ == ContourKind::line) {
      const auto path = servo.path(*move_, t);
      for (int i = 0; i < 3; ++i) slide[i] = on_line(path, i);
    } else if (kind_ == ContourKind::circle) {
      const auto turn = servo.circle(*move_, size_, t);
      for (int i = 0; i < 3; ++i) slide[i] = on_circle(turn, i);
    } else {
      for (int i = 0; i < 3; ++i) slide[i].position = T(component(place_, i));
    }
    return together(slide);
  }

  /// Where a tool stands against the contour whose commanded point is that of time t.
  template <class T> ContourDeviation<T> deviation(const Vector3<T>& tool, double t) const {
    const Vector3<T> d{tool.x - place_.x, tool.y - place_.y, tool.z - place_.z};
    const T u = along(plane_.along, d), v = along(plane_.left, d), w = along(plane_.up, d);
    if (kind_ != ContourKind::circle) return {v, w, (move_ ? move_->path(t) : 0.0) - u};
    const double c = num::cos(angle(t)), s = sense_ * num::sin(angle(t));
    const T ahead = num::atan2(v * c - u * s, u * c + v * s); // from the commanded point
    return {num::sqrt(u * u + v * v) - size_, w, (-sense_ * size_) * ahead};
  }

  /// A slide at a command: the direction in which it last moved, -1 or +1, and the time at which it last turned round,
  /// negative if it has not. Before the move it has come from below.
  struct Direction { double sign = 1, reversed = -1; };
  Direction direction(int slide, double t) const {
    const double first = component(plane_.along, slide), second = sense_ * component(plane_.left, slide);
    if (!move_ || t <= 0) return {};
    if (kind_ == ContourKind::line) return moves(first) ? Direction{first > 0 ? 1.0 : -1.0, first > 0 ? -1.0 : 0.0} : Direction{};
    if (!moves(first) && !moves(second)) return {};
    // Velocity -first sin(angle) + second cos(angle) vanishes at `turning` plus half turns.
    double turning = std::atan2(second, first);
    while (turning > tiny) turning -= std::numbers::pi;
    while (turning <= tiny - std::numbers::pi) turning += std::numbers::pi; // the last one before or at the start
    const double half_turns = std::floor((angle(t) - turning) / std::numbers::pi);
    const double last = turning + half_turns * std::numbers::pi, inside = last + std::numbers::pi / 2;
    const double sign = second * std::cos(inside) - first * std::sin(inside) > 0 ? 1 : -1;
    if (half_turns > 0) return {sign, move_->time_at(last * size_)};
    return {sign, sign > 0 ? -1.0 : 0.0};
  }

private:
  static constexpr double tiny = 1e-12; ///< a component of a direction, or an angle in rad, that is rounding
  static bool moves(double component) { return std::fabs(component) > tiny; }
  static double component(const Vector3<double>& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
  template <class T> static T along(const Vector3<double>& direction, const Vector3<T>& d) {
    return direction.x * d.x + direction.y * d.y + direction.z * d.z;
  }
  template <class T> static Motion<Vector3<T>> together(const Motion<T> (&s)[3]) {
    return {{s[0].position, s[1].position, s[2].position},
            {s[0].velocity, s[1].velocity, s[2].velocity},
            {s[0].acceleration, s[1].acceleration, s[2].acceleration}};
  }
  template <class T> Motion<T> on_line(const Motion<T>& path, int i) const {
    const double d = component(plane_.along, i);
    return {component(place_, i) + d * path.position, d * path.velocity, d * path.acceleration};
  }
  template <class T> Motion<T> on_circle(const Motion<Complex<T>>& turn, int i) const {
    const double c = size_ * component(plane_.along, i), s = size_ * sense_ * component(plane_.left, i);
    const auto mixed = [&](const Complex<T>& x) { return c * x.re + s * x.im; };
    return {component(place_, i) + mixed(turn.position), mixed(turn.velocity), mixed(turn.acceleration)};
  }
  template <class T> Motion<T> follow(const Servo<T>& servo, int i, double t) const {
    if (kind_ == ContourKind::line) return on_line(servo.path(*move_, t), i);
    if (kind_ == ContourKind::circle) return on_circle(servo.circle(*move_, size_, t), i);
    return {T(component(place_, i)), T(0.0), T(0.0)};
  }

  ContourKind kind_;
  Vector3<double> place_;
  ContourPlane plane_;
  double size_, sense_;
  std::optional<FeedProfile> move_;
};

} // namespace gumshoe::chain
