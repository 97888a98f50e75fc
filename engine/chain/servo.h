#pragma once
/// Position servo of a feed axis, solved exactly for commands that are polynomials in time or turn evenly.
///
/// The axis follows its command u by
///     first order:   x' = K (u - x)
///     second order:  x'' + 2 d w x' + w^2 (x - u) = 0,  w = 2 d K
/// with the loop gain K and the damping d. Both lag v / K behind a command of constant speed v. From rest at the command,
///     u - x = integral of q(t - tau) u'(tau) dtau,     q(0) = 1,
/// where q, like all its derivatives and antiderivatives, has the form exp(-decay t) (c C(t) + s S(t)) with C = cos(r t)
/// and S = sin(r t) / r, r^2 = w^2 - decay^2, which may be negative. Antiderivatives vanish at infinity.
/// Source: standard theory of linear systems; the integrals by parts.
#include "chain/feed_profile.h"
#include "math/quadrature.h"
#include "math/scalar.h"

namespace gumshoe::chain {

template <class T> struct Complex { T re = T(0.0), im = T(0.0); };
template <class T> Complex<T> operator+(const Complex<T>& a, const Complex<T>& b) { return {a.re + b.re, a.im + b.im}; }
template <class T> Complex<T> operator-(const Complex<T>& a, const Complex<T>& b) { return {a.re - b.re, a.im - b.im}; }
template <class T> Complex<T> operator*(const Complex<T>& a, const Complex<T>& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
template <class T> Complex<T> operator*(const T& a, const Complex<T>& b) { return {a * b.re, a * b.im}; }
template <class T> Complex<T> operator/(const Complex<T>& a, const Complex<T>& b) {
  const T n = 1.0 / (b.re * b.re + b.im * b.im);
  return {(a.re * b.re + a.im * b.im) * n, (a.im * b.re - a.re * b.im) * n};
}

/// Position, velocity, acceleration in SI; V is a number or a vector.
template <class V> struct Motion { V position{}, velocity{}, acceleration{}; };

template <class T> class Servo {
public:
  /// @param gain     K, 1/s, positive
  /// @param damping  d, positive; not read by a first-order servo
  Servo(int order, const T& gain, const T& damping) : first_order_(order == 1), gain_(gain) {
    if (first_order_) {
      decay_ = gain, square_ = gain * gain, turn_ = T(0.0);
      q_ = {T(1.0), T(0.0)};
    } else {
      const T w = 2.0 * (damping * gain);
      decay_ = damping * w, square_ = w * w, turn_ = square_ * (1.0 - damping * damping);
      q_ = {T(1.0), decay_};
    }
  }

  /// Response to the path length of a move at time t.
  Motion<T> path(const FeedProfile& move, double t) const {
    const Shape q1 = antiderivative(q_), q2 = antiderivative(q1), q3 = antiderivative(q2);
    T lag(0.0), rate(0.0);
    for (const FeedPhase& p : move.phases())
      if (p.begin < t)
        for (const double sign : {1.0, -1.0}) {
          const double tau = sign > 0 ? std::fmin(p.end, t) : p.begin;
          const double v = sign * p.feed(tau), a = sign * p.acceleration(tau), j = sign * p.j;
          const Decayed e = decayed(t - tau);
          lag = lag + (v * e(q1) - a * e(q2) + j * e(q3));
          rate = rate + (v * e(q_) - a * e(q1) + j * e(q2));
        }
    return motion(T(move.path(t)), T(move.feed(t)), lag, rate);
  }

  /// Response to exp(i s / radius), a circle of radius 1 that a move of path length s goes round.
  Motion<Complex<T>> circle(const FeedProfile& move, double radius, double t) const {
    Complex<T> lag, rate;
    const Shape of_rate{q_.s - decay_ * q_.c, -(decay_ * q_.s + turn_ * q_.c)}; // q'
    for (const FeedPhase& p : move.phases()) {
      const double end = std::fmin(p.end, t), begin = std::fmax(p.begin, t - memory());
      if (!(begin < end)) continue;
      if (p.a == 0 && p.j == 0) {
        even(p, radius, t, begin, end, q_, lag), even(p, radius, t, begin, end, of_rate, rate);
        continue;
      }
      const auto& rule = math::GaussLegendre<nodes>::rule();
      const int panels = 1 + static_cast<int>((end - begin) * (fastest() + p.feed(p.end) / radius + p.v / radius) / 6);
      const double half = (end - begin) / panels / 2;
      for (int i = 0; i < panels; ++i)
        for (int n = 0; n < nodes; ++n) {
          const auto at = static_cast<std::size_t>(n);
          const double tau = begin + half * (2 * i + 1 + rule.node[at]);
          const auto u = turning(p.path(tau) / radius, half * rule.weight[at] * p.feed(tau) / radius);
          const Decayed e = decayed(t - tau);
          lag = lag + e(q_) * u, rate = rate + e(of_rate) * u;
        }
    }
    const double s = move.path(t) / radius, omega = move.feed(t) / radius;
    const auto u = at_angle(s), du = turning(s, omega);
    const auto x = motion(u.re, du.re, lag.re, -rate.re), y = motion(u.im, du.im, lag.im, -rate.im);
    return {{x.position, y.position}, {x.velocity, y.velocity}, {x.acceleration, y.acceleration}};
  }

private:
  static constexpr int nodes = 16; ///< a panel of 6 time constants is integrated to the last bit
  /// exp(-decay t) (c C(t) + s S(t))
  template <class V> struct ShapeOf { V c, s; };
  using Shape = ShapeOf<T>;
  struct Decayed {
    T c, s; ///< exp(-decay t) C(t), exp(-decay t) S(t)
    template <class V> V operator()(const ShapeOf<V>& q) const { return c * q.c + s * q.s; }
  };

  Decayed decayed(double t) const {
    const T z = turn_ * (t * t);
    const double size = num::value(z);
    if (size > -1 && size < 1) { // C and S by their series: r may be zero
      T c(1.0), s(1.0);
      for (int n = 10; n > 0; --n) c = 1.0 - z / (2.0 * n * (2 * n - 1)) * c, s = 1.0 - z / (2.0 * n * (2 * n + 1)) * s;
      const T e = num::exp(-(decay_ * t));
      return {e * c, t * (e * s)};
    }
    const T r = num::sqrt(size > 0 ? turn_ : -turn_);
    if (size > 0) {
      const T e = num::exp(-(decay_ * t));
      return {e * num::cos(r * t), e * num::sin(r * t) / r};
    }
    const T slow = num::exp(-((decay_ - r) * t)), fast = num::exp(-((decay_ + r) * t));
    return {0.5 * (slow + fast), 0.5 * (slow - fast) / r};
  }
  /// Minus the derivative of the result is `q`.
  Shape antiderivative(const Shape& q) const {
    const T c = (q.s + decay_ * q.c) / square_;
    return {c, decay_ * c - q.c};
  }
  static Complex<T> at_angle(double angle) { return {T(num::cos(angle)), T(num::sin(angle))}; }
  /// Derivative of exp(i angle) as the angle grows by `by`.
  static Complex<T> turning(double angle, double by) { return {T(-by * num::sin(angle)), T(by * num::cos(angle))}; }

  /// Adds the integral of q(t - tau) d/dtau exp(i s / radius) over an even stretch: q times exp(i omega tau) has an
  /// antiderivative of the same form.
  void even(const FeedPhase& p, double radius, double t, double begin, double end, const Shape& q, Complex<T>& sum) const {
    const double omega = p.v / radius;
    const Complex<T> rate{decay_, T(omega)};
    const Complex<T> c = (Complex<T>{q.s, T(0.0)} + q.c * rate) / (rate * rate + Complex<T>{turn_, T(0.0)});
    const Complex<T> s = rate * c - Complex<T>{q.c, T(0.0)};
    const auto at = [&](double tau) {
      const Decayed e = decayed(t - tau);
      return (e.c * c + e.s * s) * turning(p.path(tau) / radius, omega);
    };
    sum = sum + (at(end) - at(begin));
  }
  /// @param lag   u - x  @param rate  x', which second-order servos need
  Motion<T> motion(const T& u, const T& du, const T& lag, const T& rate) const {
    const T velocity = first_order_ ? gain_ * lag : rate;
    const T acceleration = first_order_ ? gain_ * (du - velocity) : square_ * lag - 2.0 * (decay_ * velocity);
    return {u - lag, velocity, acceleration};
  }
  /// What lies further back, s, has decayed by 20 digits: no pole is slower than the gain or the decay.
  double memory() const { return 46 / std::fmin(num::value(gain_), num::value(decay_)); }
  double fastest() const { return 2 * num::value(decay_) + std::sqrt(std::fabs(num::value(turn_))); } ///< 1/s

  bool first_order_;
  T gain_, decay_, square_, turn_;
  Shape q_;
};

} // namespace gumshoe::chain
