#pragma once
/// Dual numbers: exact derivatives by forward-mode automatic differentiation.
///
/// `Dual<R, N>` carries a value and its N partial derivatives. R is double, or a dual itself, which yields second
/// derivatives: in Dual<Dual<double, N>, N> the entry x.d[i].d[j] is the second derivative with respect to variables i
/// and j. A derivative has the unit of the value divided by that of the variable. They are small and nest, which Ceres'
/// Jet does not; Jet stays inside math/least_squares.
///
/// Source: Griewank and Walther, Evaluating Derivatives, 2nd ed. 2008, chapter 3.
#include <array>
#include <cmath>
#include <type_traits>

#include "math/lanes.h"

namespace gumshoe {

/// A value and its derivatives with respect to N independent variables. Constructed from a plain number it is a
/// constant: all derivatives are zero.
template <class R, int N> struct Dual {
  R v{};
  std::array<R, N> d{};
  Dual() = default;
  Dual(double value) : v(value) { d.fill(R(0.0)); } // NOLINT: constants enter formulas unmarked
  template <class Q, class = std::enable_if_t<std::is_same_v<Q, R> && !std::is_same_v<R, double>>>
  Dual(const Q& value) : v(value) {
    d.fill(R(0.0));
  }
  /// Independent variable i, 0 <= i < N, at `value`: its derivative with respect to itself is 1.
  static Dual variable(const R& value, int i) {
    Dual x;
    x.v = value;
    x.d.fill(R(0.0));
    x.d[static_cast<std::size_t>(i)] = R(1.0);
    return x;
  }
};

/// The chain rule for a function of one argument: value f and derivative df, both at a.
template <class R, int N> Dual<R, N> chain_rule(const R& f, const R& df, const Dual<R, N>& a) {
  Dual<R, N> r;
  r.v = f;
  for (int i = 0; i < N; ++i) r.d[i] = df * a.d[i];
  return r;
}
/// The chain rule for a function of two arguments: value f and partial derivatives da, db, at (a, b).
template <class R, int N>
Dual<R, N> chain_rule(const R& f, const R& da, const Dual<R, N>& a, const R& db, const Dual<R, N>& b) {
  Dual<R, N> r;
  r.v = f;
  for (int i = 0; i < N; ++i) r.d[i] = da * a.d[i] + db * b.d[i];
  return r;
}

template <class R, int N> Dual<R, N> operator+(const Dual<R, N>& a, const Dual<R, N>& b) {
  return chain_rule<R, N>(a.v + b.v, R(1.0), a, R(1.0), b);
}
template <class R, int N> Dual<R, N> operator-(const Dual<R, N>& a, const Dual<R, N>& b) {
  return chain_rule<R, N>(a.v - b.v, R(1.0), a, R(-1.0), b);
}
template <class R, int N> Dual<R, N> operator*(const Dual<R, N>& a, const Dual<R, N>& b) {
  return chain_rule<R, N>(a.v * b.v, b.v, a, a.v, b);
}
template <class R, int N> Dual<R, N> operator/(const Dual<R, N>& a, const Dual<R, N>& b) {
  const R q = a.v / b.v;
  return chain_rule<R, N>(q, R(1.0) / b.v, a, -q / b.v, b);
}
template <class R, int N> Dual<R, N> operator-(const Dual<R, N>& a) { return chain_rule<R, N>(-a.v, R(-1.0), a); }
template <class R, int N> Dual<R, N> operator+(double a, const Dual<R, N>& b) { return Dual<R, N>(a) + b; }
template <class R, int N> Dual<R, N> operator+(const Dual<R, N>& a, double b) { return a + Dual<R, N>(b); }
template <class R, int N> Dual<R, N> operator-(double a, const Dual<R, N>& b) { return Dual<R, N>(a) - b; }
template <class R, int N> Dual<R, N> operator-(const Dual<R, N>& a, double b) { return a - Dual<R, N>(b); }
template <class R, int N> Dual<R, N> operator*(double a, const Dual<R, N>& b) { return Dual<R, N>(a) * b; }
template <class R, int N> Dual<R, N> operator*(const Dual<R, N>& a, double b) { return a * Dual<R, N>(b); }
template <class R, int N> Dual<R, N> operator/(double a, const Dual<R, N>& b) { return Dual<R, N>(a) / b; }
template <class R, int N> Dual<R, N> operator/(const Dual<R, N>& a, double b) { return a / Dual<R, N>(b); }
template <class R, int N> Dual<R, N>& operator+=(Dual<R, N>& a, const Dual<R, N>& b) { return a = a + b; }
template <class R, int N> Dual<R, N>& operator-=(Dual<R, N>& a, const Dual<R, N>& b) { return a = a - b; }

} // namespace gumshoe
