#pragma once
/// The functions that the physics may call on its scalar, which is double, Lanes, or a (nested) dual number over double.
///
/// Elementary functions of a double go through a lane, so that scalar runs, batched runs and every instruction set give
/// the same bits. Angles are in rad. sin and cos are accurate to about one unit in the last place for |x| < 1e6; exp is 0
/// below -708 and stays at its value for 709 above. elementary.h has the whole range, for formulas that users write.
#include <utility>

#include "math/dual.h"
#include "math/lane_functions.h"
#include "math/lanes.h"

namespace gumshoe::num {

inline double sqrt(double x) { return std::sqrt(x); }
inline double sin(double x) { return sine_cosine_lane(Lanes(x)).sine.get(0); }
inline double cos(double x) { return sine_cosine_lane(Lanes(x)).cosine.get(0); }
inline double exp(double x) { return exp_lane(Lanes(x)).get(0); }
inline double atan2(double y, double x) { return xsimd::atan2(Lanes(y), Lanes(x)).get(0); }
inline double abs(double x) { return std::fabs(x); }

// Extended precision serves to polish a solution where large products cancel; the C library's functions do.
inline long double sqrt(long double x) { return std::sqrt(x); }
inline long double sin(long double x) { return std::sin(x); }
inline long double cos(long double x) { return std::cos(x); }
inline long double atan2(long double y, long double x) { return std::atan2(y, x); }

inline Lanes sqrt(const Lanes& x) { return xsimd::sqrt(x); }
inline Lanes sin(const Lanes& x) { return sine_cosine_lane(x).sine; }
inline Lanes cos(const Lanes& x) { return sine_cosine_lane(x).cosine; }
inline Lanes exp(const Lanes& x) { return exp_lane(x); }
inline Lanes atan2(const Lanes& y, const Lanes& x) { return xsimd::atan2(y, x); }
inline Lanes abs(const Lanes& x) { return xsimd::abs(x); }

// Declared first: each needs the others at the level below.
template <class R, int N> Dual<R, N> sqrt(const Dual<R, N>& x);
template <class R, int N> Dual<R, N> sin(const Dual<R, N>& x);
template <class R, int N> Dual<R, N> cos(const Dual<R, N>& x);
template <class R, int N> Dual<R, N> exp(const Dual<R, N>& x);
template <class R, int N> Dual<R, N> atan2(const Dual<R, N>& y, const Dual<R, N>& x);

template <class R, int N> Dual<R, N> sqrt(const Dual<R, N>& x) {
  const R s = sqrt(x.v);
  return chain_rule<R, N>(s, 0.5 / s, x);
}
template <class R, int N> Dual<R, N> sin(const Dual<R, N>& x) { return chain_rule<R, N>(sin(x.v), cos(x.v), x); }
template <class R, int N> Dual<R, N> cos(const Dual<R, N>& x) { return chain_rule<R, N>(cos(x.v), -sin(x.v), x); }
template <class R, int N> Dual<R, N> exp(const Dual<R, N>& x) {
  const R e = exp(x.v);
  return chain_rule<R, N>(e, e, x);
}
template <class R, int N> Dual<R, N> atan2(const Dual<R, N>& y, const Dual<R, N>& x) {
  const R n = 1.0 / (x.v * x.v + y.v * y.v);
  return chain_rule<R, N>(atan2(y.v, x.v), x.v * n, y, -(y.v * n), x);
}

/// The plain number inside x, through every level of dual numbers. Branches of the physics may depend on it.
inline double value(double x) { return x; }
inline double value(long double x) { return static_cast<double>(x); }
template <class R, int N> double value(const Dual<R, N>& x) { return value(x.v); }

/// Derivative +1 at zero, where there is none: the caller reports a kink.
template <class R, int N> Dual<R, N> abs(const Dual<R, N>& x) { return value(x) < 0 ? -x : x; }

/// Number of extra Newton steps at a root, already converged in double, after which all derivatives are right: each step
/// settles one level of duals.
template <class T> inline constexpr int derivative_levels = 0;
template <> inline constexpr int derivative_levels<long double> = 2; // no derivatives, but digits to gain
template <class R, int N> inline constexpr int derivative_levels<Dual<R, N>> = 1 + derivative_levels<R>;

/// mask ? a : b, lane by lane. Both sides are evaluated, so neither may trap.
inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline Lanes select(const Lanes::batch_bool_type& mask, const Lanes& a, const Lanes& b) {
  return xsimd::select(mask, a, b);
}
/// True if the mask holds in any lane.
inline bool any(bool mask) { return mask; }
inline bool any(const Lanes::batch_bool_type& mask) { return xsimd::any(mask); }

} // namespace gumshoe::num
