#pragma once
/// A point that two rotary axes of any machine turn, both in the table or both in the head: where it goes, and which
/// errors of the angles bring it nearest to where it was found.
#include "chain/two_rotary_axes.h"

namespace gumshoe::chain {

/// Angles about X, Y and Z, or their errors, rad; 0 about an axis that the machine does not have.
template <class T> struct Angles { T alpha = T(0.0), beta = T(0.0), gamma = T(0.0); };
template <class T> Angles<T> operator+(const Angles<T>& a, const Angles<T>& b) {
  return {a.alpha + b.alpha, a.beta + b.beta, a.gamma + b.gamma};
}
/// The one about X, Y or Z. @param direction 0, 1, 2
template <class T> const T& angle_about(int direction, const Angles<T>& by) {
  return direction == 0 ? by.alpha : direction == 1 ? by.beta : by.gamma;
}

/// The point's place is counted from the point of the second axis, the result from that of the first.
template <class T> struct TurnedByTwo {
  const TwoRotaryAxes& axes;
  Vector3<T> offset; ///< from the first axis' point to the second's, m

  Matrix3<T> first(const Angles<T>& by) const {
    return turn_about(axes.first.direction, angle_about(axes.first.direction, by));
  }
  Vector3<T> turned_by_second(const Vector3<T>& ball, const Angles<T>& by) const {
    return turn_about(axes.second.direction, angle_about(axes.second.direction, by)) * ball;
  }
  Vector3<T> place(const Vector3<T>& ball, const Angles<T>& by) const {
    return first(by) * (offset + turned_by_second(ball, by));
  }

  /// By how much an error of either angle moves the ball, m/rad.
  struct Levers {
    Vector3<T> first, second;
  };
  Levers levers(const Vector3<T>& ball, const Angles<T>& by) const {
    const T one(1.0);
    return {cross(along(axes.first.direction, one), place(ball, by)),
            first(by) * cross(along(axes.second.direction, one), turned_by_second(ball, by))};
  }
  /// Area that the levers span by the longer one, m: 0 where the errors cannot be distinguished.
  T smallest_lever(const Vector3<T>& ball, const Angles<T>& by) const {
    const auto [a, b] = levers(ball, by);
    const T aa = dot(a, a), bb = dot(b, b), longest = T(0.5) * (aa + bb + num::abs(aa - bb)) + T(1e-30);
    return num::sqrt((aa * bb - dot(a, b) * dot(a, b)) / longest);
  }

  /// Least squares of all three equations, by Gauss-Newton in a fixed number of steps.
  Angles<T> errors(const Vector3<T>& ball, const Angles<T>& commanded, const Vector3<T>& found) const {
    constexpr int steps = 8;
    T d[3] = {T(0.0), T(0.0), T(0.0)};
    for (int k = 0; k < steps; ++k) {
      const auto by = commanded + Angles<T>{d[0], d[1], d[2]};
      const auto [a, b] = levers(ball, by);
      const Vector3<T> left = found - place(ball, by);
      const T aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), al = dot(a, left), bl = dot(b, left);
      const T one_by = T(1.0) / (aa * bb - ab * ab);
      d[axes.first.direction] = d[axes.first.direction] + one_by * (bb * al - ab * bl);
      d[axes.second.direction] = d[axes.second.direction] + one_by * (aa * bl - ab * al);
    }
    return {d[0], d[1], d[2]};
  }
};

} // namespace gumshoe::chain
