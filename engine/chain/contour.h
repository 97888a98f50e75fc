#pragma once
/// A commanded contour, and slides X, Y, Z whose servos follow it. What is commanded is exact: plain doubles in SI.
///
/// Servos are linear, so that a contour of several moves is followed by the sum of what each move alone would do; what is
/// left of its lag at a corner is in that sum.
#include <numbers>
#include <optional>

#include "chain/servo.h"
#include "math/pose.h"

namespace gumshoe::chain {

/// A point at which the slides stand; a line from there; a circle about it, from where its plane's first direction points,
/// which may rise evenly along `up`, a helix; a regular polygon that starts there along its first side, with a stop at each corner.
enum class ContourKind { point, line, circle, polygon };

/// The plane of a contour: `along` has the azimuth `angle` from +X towards +Y and rises by `elevation`; `left` is
/// horizontal; `up` is square to both.
struct ContourPlane {
  Vector3<double> along, left, up;
  ContourPlane(double angle, double elevation) {
    const double c = num::cos(angle), s = num::sin(angle), ce = num::cos(elevation), se = num::sin(elevation);
    along = {c * ce, s * ce, se}, left = {-s, c, 0.0}, up = {-(c * se), -(s * se), ce};
  }
};

/// How a circle goes on: once round and level, if it does not rise.
struct Winding {
  double turns = 1; ///< positive
  double rise = 0;  ///< along `up` per turn, m
};

/// The corners of a regular polygon in its plane. A side's direction turns towards `left` if `sense` is 1, else away.
struct Corners {
  int sides = 1;
  double dwell = 0; ///< s, between the stop of the command at a corner and the start of the next side
};

/// A point by its distance from the contour.
template <class T> struct ContourDeviation {
  T normal;    ///< in the contour's plane: to the left of a line's direction, outwards from a circle or polygon; m
  T plane;     ///< out of the plane, along `up`, m
  T following; ///< how far the commanded point is ahead, along the contour, m
};

class Contour {
public:
  /// @param size   length of a line or of a polygon's side, radius of a circle, m, positive; not read for a point
  /// @param sense  of a circle or polygon in its plane: 1 from `along` towards `left` (counter-clockwise from above), or -1
  Contour(ContourKind kind, const Vector3<double>& place, const ContourPlane& plane, double size, double sense,
          double feed, double acceleration, double jerk, const Corners& corners = {}, const Winding& winding = {})
      : kind_(kind), place_(place), plane_(plane), size_(size), sense_(sense),
        corners_(kind == ContourKind::polygon ? corners : Corners{}), rise_(winding.rise / (2 * std::numbers::pi)),
        way_(std::hypot(size, rise_)) {
    if (kind != ContourKind::point)
      move_.emplace(kind == ContourKind::circle ? 2 * std::numbers::pi * winding.turns * way_ : size, feed, acceleration, jerk);
  }

  /// Turns the contour with the frame in which it is stated.
  void turn(const Matrix3<double>& by) {
    place_ = by * place_;
    plane_.along = by * plane_.along, plane_.left = by * plane_.left, plane_.up = by * plane_.up;
  }

  /// The feed along a line, a circle or each side of a polygon; null for a point.
  const FeedProfile* move() const { return move_ ? &*move_ : nullptr; }
  double end() const { return move_ ? start_of(corners_.sides - 1) + move_->end() : 0; } ///< s
  /// The side of a polygon that was begun last, from 0, and when, s.
  int side(double t) const {
    int k = 0;
    while (k + 1 < corners_.sides && t >= start_of(k + 1)) ++k;
    return k;
  }
  double start_of(int side) const { return side == 0 ? 0 : side * (move_->end() + corners_.dwell); }
  /// The corner of a polygon at which a side begins.
  Vector3<double> corner(int side) const {
    Vector3<double> at = place_;
    for (int k = 0; k < side; ++k) at = at + size_ * direction_of(k);
    return at;
  }
  /// Commanded angle round a circle from its start, rad; positive in the circle's sense.
  double angle(double t) const { return move_ ? move_->path(t) / way_ : 0; }

  /// The commanded point.
  Vector3<double> commanded(double t) const {
    if (!move_) return place_;
    if (kind_ != ContourKind::circle) {
      const int k = side(t);
      return corner(k) + move_->path(t - start_of(k)) * direction_of(k);
    }
    return place_ + size_ * (num::cos(angle(t)) * plane_.along + sense_ * num::sin(angle(t)) * plane_.left) +
           rise_ * angle(t) * plane_.up;
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
    if (kind_ == ContourKind::line || kind_ == ContourKind::polygon) {
      for (int i = 0; i < 3; ++i) slide[i].position = T(component(place_, i));
      for (int k = 0; k <= side(t); ++k) {
        const auto path = servo.path(*move_, t - start_of(k));
        for (int i = 0; i < 3; ++i) add_side(slide[i], path, k, i);
      }
    } else if (kind_ == ContourKind::circle) {
      const auto turn = servo.circle(*move_, way_, t);
      for (int i = 0; i < 3; ++i) slide[i] = on_circle(turn, i);
      if (rise_ != 0)
        for (int i = 0; i < 3; ++i) rise(slide[i], servo, i, t);
    } else {
      for (int i = 0; i < 3; ++i) slide[i].position = T(component(place_, i));
    }
    return together(slide);
  }

  /// Where a tool stands against the contour whose commanded point is that of time t.
  template <class T> ContourDeviation<T> deviation(const Vector3<T>& tool, double t) const {
    const Vector3<T> d{tool.x - place_.x, tool.y - place_.y, tool.z - place_.z};
    const T u = along(plane_.along, d), v = along(plane_.left, d), w = along(plane_.up, d);
    if (kind_ == ContourKind::polygon) return from_polygon(u, v, w, t);
    if (kind_ != ContourKind::circle) return {v, w, (move_ ? move_->path(t) : 0.0) - u};
    const double c = num::cos(angle(t)), s = sense_ * num::sin(angle(t));
    const T ahead = num::atan2(v * c - u * s, u * c + v * s); // from the commanded point
    if (rise_ == 0) return {num::sqrt(u * u + v * v) - size_, w, (-sense_ * size_) * ahead};
    // On the unrolled cylinder the helix is a straight line: across it and along it.
    const T arc = (sense_ * size_) * ahead, up = w - rise_ * angle(t);
    return {num::sqrt(u * u + v * v) - size_, (size_ * up - rise_ * arc) / way_, -(size_ * arc + rise_ * up) / way_};
  }

  /// A slide at a command: the direction in which it last moved, -1 or +1, and the time at which it last turned round,
  /// negative if it has not. Before the move it has come from below.
  struct Direction { double sign = 1, reversed = -1; };
  Direction direction(int slide, double t) const {
    const double first = component(plane_.along, slide), second = sense_ * component(plane_.left, slide);
    if (!move_ || t <= 0) return {};
    if (kind_ != ContourKind::circle) {
      Direction now;
      for (int k = 0; k <= side(t); ++k)
        if (const double d = component(direction_of(k), slide); moves(d) && d * now.sign < 0) now = {-now.sign, start_of(k)};
      return now;
    }
    if (!moves(first) && !moves(second)) {
      const double up = rise_ * component(plane_.up, slide);
      return moves(up) && up < 0 ? Direction{-1.0, 0.0} : Direction{};
    }
    // Velocity -first sin(angle) + second cos(angle) vanishes at `turning` plus half turns.
    double turning = std::atan2(second, first);
    while (turning > tiny) turning -= std::numbers::pi;
    while (turning <= tiny - std::numbers::pi) turning += std::numbers::pi; // the last one before or at the start
    const double half_turns = std::floor((angle(t) - turning) / std::numbers::pi);
    const double last = turning + half_turns * std::numbers::pi, inside = last + std::numbers::pi / 2;
    const double sign = second * std::cos(inside) - first * std::sin(inside) > 0 ? 1 : -1;
    if (half_turns > 0) return {sign, move_->time_at(last * way_)};
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
  /// Azimuth of a side in the plane, rad, and its direction.
  double azimuth(int side) const { return sense_ * side * (2 * std::numbers::pi / corners_.sides); }
  Vector3<double> direction_of(int side) const {
    if (side == 0) return plane_.along;
    return num::cos(azimuth(side)) * plane_.along + num::sin(azimuth(side)) * plane_.left;
  }
  template <class T> static void add(Motion<T>& slide, double share, const Motion<T>& path) {
    slide.position = slide.position + share * path.position;
    slide.velocity = slide.velocity + share * path.velocity;
    slide.acceleration = slide.acceleration + share * path.acceleration;
  }
  template <class T> void add_side(Motion<T>& slide, const Motion<T>& path, int side, int i) const {
    add(slide, component(direction_of(side), i), path);
  }
  /// From the nearest point of the polygon: on a side, or a corner, which only points outside are nearest to.
  template <class T> ContourDeviation<T> from_polygon(const T& u, const T& v, const T& w, double t) const {
    double x = 0, y = 0, nearest = INFINITY;
    T normal(0.0), along(0.0);
    for (int k = 0; k < corners_.sides; ++k) {
      const double c = num::cos(azimuth(k)), s = num::sin(azimuth(k));
      const T on = (u - x) * c + (v - y) * s, outwards = sense_ * ((u - x) * s - (v - y) * c);
      const double before = num::value(on), beyond = before < 0 ? before : std::fmax(0, before - size_);
      if (const double distance = std::hypot(beyond, num::value(outwards)); distance < nearest) {
        nearest = distance;
        const T past = before < 0 ? on : on - size_;
        normal = beyond == 0 ? outwards : num::sqrt(past * past + outwards * outwards);
        along = k * size_ + (before < 0 ? T(0.0) : before > size_ ? T(size_) : on);
      }
      x += size_ * c, y += size_ * s;
    }
    const int k = side(t);
    const T ahead = k * size_ + move_->path(t - start_of(k)) - along;
    const double round = corners_.sides * size_; // a closed way: the shorter one counts
    return {normal, w, ahead - round * std::round(num::value(ahead) / round)};
  }
  template <class T> Motion<T> on_circle(const Motion<Complex<T>>& turn, int i) const {
    const double c = size_ * component(plane_.along, i), s = size_ * sense_ * component(plane_.left, i);
    const auto mixed = [&](const Complex<T>& x) { return c * x.re + s * x.im; };
    return {component(place_, i) + mixed(turn.position), mixed(turn.velocity), mixed(turn.acceleration)};
  }
  /// Adds what a slide rises on a helix.
  template <class T> void rise(Motion<T>& slide, const Servo<T>& servo, int i, double t) const {
    add(slide, rise_ / way_ * component(plane_.up, i), servo.path(*move_, t));
  }
  template <class T> Motion<T> follow(const Servo<T>& servo, int i, double t) const {
    if (kind_ == ContourKind::circle) {
      auto slide = on_circle(servo.circle(*move_, way_, t), i);
      if (rise_ != 0) rise(slide, servo, i, t);
      return slide;
    }
    Motion<T> slide{T(component(place_, i)), T(0.0), T(0.0)};
    if (kind_ != ContourKind::point)
      for (int k = 0; k <= side(t); ++k) add_side(slide, servo.path(*move_, t - start_of(k)), k, i);
    return slide;
  }

  ContourKind kind_;
  Vector3<double> place_;
  ContourPlane plane_;
  double size_, sense_;
  Corners corners_;
  double rise_, way_; ///< of a circle, m per rad: along `up`, and in all
  std::optional<FeedProfile> move_;
};

} // namespace gumshoe::chain
