#pragma once
/// Elementary functions over their whole range for every scalar: double, Lanes and nested dual numbers.
///
/// These are the functions that formulas of a scenario may call. The values are those of elementary_lanes.h; a double
/// goes through a lane, so that scalar and batched runs give the same bits. Angles are in rad, all else is dimensionless
/// or keeps the unit of its argument (abs, min, max, hypot, sqrt of a square).
///
/// | function                | domain                 | at its end                       |
/// |-------------------------|------------------------|----------------------------------|
/// | sin, cos, tan           | all finite arguments   | NaN for an infinite argument     |
/// | asin, acos              | [-1, 1]                | NaN outside                      |
/// | atan, sinh, cosh, tanh  | all                    | infinite where they overflow     |
/// | exp                     | all                    | 0 below -708, infinite above 709 |
/// | log, log10              | x > 0                  | -infinity at 0, NaN below        |
/// | sqrt                    | x >= 0                 | NaN below                        |
/// | pow(x, y)               | x > 0, or whole y      | NaN otherwise; pow(0, 0) = 1     |
/// | atan2(y, x)             | all                    | 0 at the origin                  |
///
/// Errors are a few units in the last place. Derivatives follow the chain rule and are exact up to rounding; where a
/// function has none (abs, min and max at a tie) they are those of the branch that is taken.
#include "math/dual.h"
#include "math/elementary_lanes.h"
#include "math/scalar.h"

namespace gumshoe::elementary {

#define GUMSHOE_ELEMENTARY_1(name, lane)                                                                               \
  inline Lanes name(const Lanes& x) { return lane(x); }                                                                \
  inline double name(double x) { return lane(Lanes(x)).get(0); }
#define GUMSHOE_ELEMENTARY_2(name, lane)                                                                               \
  inline Lanes name(const Lanes& x, const Lanes& y) { return lane(x, y); }                                             \
  inline double name(double x, double y) { return lane(Lanes(x), Lanes(y)).get(0); }

GUMSHOE_ELEMENTARY_1(sin, sin_lane)
GUMSHOE_ELEMENTARY_1(cos, cos_lane)
GUMSHOE_ELEMENTARY_1(tan, tan_lane)
GUMSHOE_ELEMENTARY_1(asin, asin_lane)
GUMSHOE_ELEMENTARY_1(acos, acos_lane)
GUMSHOE_ELEMENTARY_1(atan, atan_lane)
GUMSHOE_ELEMENTARY_1(sinh, sinh_lane)
GUMSHOE_ELEMENTARY_1(cosh, cosh_lane)
GUMSHOE_ELEMENTARY_1(tanh, tanh_lane)
GUMSHOE_ELEMENTARY_1(exp, exp_whole_lane)
GUMSHOE_ELEMENTARY_1(log, log_whole_lane)
GUMSHOE_ELEMENTARY_1(log10, log10_lane)
GUMSHOE_ELEMENTARY_1(sqrt, sqrt_lane)
GUMSHOE_ELEMENTARY_1(abs, xsimd::abs)
GUMSHOE_ELEMENTARY_2(atan2, atan2_lane)
GUMSHOE_ELEMENTARY_2(pow, pow_lane)
GUMSHOE_ELEMENTARY_2(hypot, hypot_lane)
GUMSHOE_ELEMENTARY_2(min, min_lane)
GUMSHOE_ELEMENTARY_2(max, max_lane)

#undef GUMSHOE_ELEMENTARY_1
#undef GUMSHOE_ELEMENTARY_2

// Declared first: each needs the others at the level below.
#define GUMSHOE_DUAL_1(name) template <class R, int N> Dual<R, N> name(const Dual<R, N>& x);
#define GUMSHOE_DUAL_2(name) template <class R, int N> Dual<R, N> name(const Dual<R, N>& x, const Dual<R, N>& y);
GUMSHOE_DUAL_1(sin)
GUMSHOE_DUAL_1(cos)
GUMSHOE_DUAL_1(tan)
GUMSHOE_DUAL_1(asin)
GUMSHOE_DUAL_1(acos)
GUMSHOE_DUAL_1(atan)
GUMSHOE_DUAL_1(sinh)
GUMSHOE_DUAL_1(cosh)
GUMSHOE_DUAL_1(tanh)
GUMSHOE_DUAL_1(exp)
GUMSHOE_DUAL_1(log)
GUMSHOE_DUAL_1(log10)
GUMSHOE_DUAL_1(sqrt)
GUMSHOE_DUAL_2(atan2)
GUMSHOE_DUAL_2(pow)
GUMSHOE_DUAL_2(hypot)
#undef GUMSHOE_DUAL_1
#undef GUMSHOE_DUAL_2

template <class R, int N> Dual<R, N> sin(const Dual<R, N>& x) { return chain_rule<R, N>(sin(x.v), cos(x.v), x); }
template <class R, int N> Dual<R, N> cos(const Dual<R, N>& x) { return chain_rule<R, N>(cos(x.v), -sin(x.v), x); }
template <class R, int N> Dual<R, N> tan(const Dual<R, N>& x) {
  const R t = tan(x.v);
  return chain_rule<R, N>(t, 1.0 + t * t, x);
}
template <class R, int N> Dual<R, N> asin(const Dual<R, N>& x) {
  return chain_rule<R, N>(asin(x.v), 1.0 / sqrt((1.0 - x.v) * (1.0 + x.v)), x);
}
template <class R, int N> Dual<R, N> acos(const Dual<R, N>& x) {
  return chain_rule<R, N>(acos(x.v), -1.0 / sqrt((1.0 - x.v) * (1.0 + x.v)), x);
}
template <class R, int N> Dual<R, N> atan(const Dual<R, N>& x) {
  return chain_rule<R, N>(atan(x.v), 1.0 / (1.0 + x.v * x.v), x);
}
template <class R, int N> Dual<R, N> sinh(const Dual<R, N>& x) { return chain_rule<R, N>(sinh(x.v), cosh(x.v), x); }
template <class R, int N> Dual<R, N> cosh(const Dual<R, N>& x) { return chain_rule<R, N>(cosh(x.v), sinh(x.v), x); }
template <class R, int N> Dual<R, N> tanh(const Dual<R, N>& x) {
  const R t = tanh(x.v);
  return chain_rule<R, N>(t, (1.0 - t) * (1.0 + t), x);
}
template <class R, int N> Dual<R, N> exp(const Dual<R, N>& x) {
  const R e = exp(x.v);
  return chain_rule<R, N>(e, e, x);
}
template <class R, int N> Dual<R, N> log(const Dual<R, N>& x) { return chain_rule<R, N>(log(x.v), 1.0 / x.v, x); }
template <class R, int N> Dual<R, N> log10(const Dual<R, N>& x) {
  return chain_rule<R, N>(log10(x.v), 4.34294481903251816668e-01 / x.v, x);
}
template <class R, int N> Dual<R, N> sqrt(const Dual<R, N>& x) {
  const R s = sqrt(x.v);
  return chain_rule<R, N>(s, 0.5 / s, x);
}
template <class R, int N> Dual<R, N> atan2(const Dual<R, N>& y, const Dual<R, N>& x) {
  const R n = 1.0 / (x.v * x.v + y.v * y.v);
  return chain_rule<R, N>(atan2(y.v, x.v), x.v * n, y, -(y.v * n), x);
}
/// For x <= 0 the derivative with respect to the exponent does not exist; the exponent is treated as constant there.
template <class R, int N> Dual<R, N> pow(const Dual<R, N>& x, const Dual<R, N>& y) {
  const R p = pow(x.v, y.v);
  return chain_rule<R, N>(p, y.v * pow(x.v, y.v - 1.0), x, num::value(x) > 0 ? R(p * log(x.v)) : R(0.0), y);
}
template <class R, int N> Dual<R, N> hypot(const Dual<R, N>& x, const Dual<R, N>& y) {
  const R h = hypot(x.v, y.v);
  return chain_rule<R, N>(h, x.v / h, x, y.v / h, y);
}
/// Derivative +1 at zero.
template <class R, int N> Dual<R, N> abs(const Dual<R, N>& x) { return num::value(x) < 0 ? -x : x; }
/// A NaN in either argument is the result. At a tie the derivative is that of x.
template <class R, int N> Dual<R, N> min(const Dual<R, N>& x, const Dual<R, N>& y) {
  return num::value(x) <= num::value(y) || num::value(x) != num::value(x) ? x : y;
}
template <class R, int N> Dual<R, N> max(const Dual<R, N>& x, const Dual<R, N>& y) {
  return num::value(x) >= num::value(y) || num::value(x) != num::value(x) ? x : y;
}

} // namespace gumshoe::elementary
