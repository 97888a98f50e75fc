#pragma once
/// Elementary functions on lanes.
///
/// They use only additions, multiplications, divisions, square roots, bit operations and selections, so that a lane has
/// the same bits on every instruction set and whatever its neighbours hold. (xsimd's sin and cos choose their argument
/// reduction by looking at all lanes.) Angles are in rad, everything else is dimensionless. The polynomials of log, exp,
/// sin and cos are those of fdlibm (Sun Microsystems 1993); "ulp" is a unit in the last place.
#include <cstdint>

#include "math/lanes.h"

namespace gumshoe {

/// The bits of lanes, as unsigned 64-bit integers.
template <class L> using Bits = xsimd::batch<std::uint64_t, typename L::arch_type>;

/// The bit patterns of the lanes, and back.
template <class L> Bits<L> bits_of(const L& x) { return xsimd::bitwise_cast<Bits<L>>(x); }
template <class L> L lanes_of(const Bits<L>& x) { return xsimd::bitwise_cast<L>(x); }

/// Converts integers below 2^52, held in the bits, to doubles; exact.
template <class L> L to_double(const Bits<L>& x) {
  return lanes_of<L>(x | Bits<L>(std::uint64_t{0x4330000000000000u})) - L(0x1p52);
}

/// The polynomial c[0] + c[1] x + ... + c[N-1] x^(N-1), by Horner's rule.
template <class L, std::size_t N> L polynomial(const L& x, const double (&c)[N]) {
  L y(c[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) y = y * x + L(c[i]);
  return y;
}

/// Natural logarithm of positive numbers, subnormal ones included; error below 1 ulp. Undefined for x <= 0, infinity and
/// NaN. Source: fdlibm, e_log.c.
template <class L> L log_lane(L x) {
  const auto tiny = x < L(0x1p-1022);
  x = xsimd::select(tiny, x * L(0x1p54), x);
  // sqrt(1/2) <= m < sqrt(2)
  const Bits<L> shifted = bits_of(x) + Bits<L>(std::uint64_t{0x3ff0000000000000u - 0x3fe6a09e00000000u});
  const L k = to_double<L>(shifted >> 52) - xsimd::select(tiny, L(1023.0 + 54.0), L(1023.0));
  const L m = lanes_of<L>((shifted & Bits<L>(std::uint64_t{0x000fffffffffffffu})) +
                          Bits<L>(std::uint64_t{0x3fe6a09e00000000u}));
  const L f = m - L(1.0);
  const L half_square = L(0.5) * f * f;
  const L s = f / (L(2.0) + f);
  const L z = s * s;
  constexpr double c[] = {6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
                          2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
                          1.479819860511658591e-01};
  const L r = z * polynomial(z, c);
  return k * L(6.93147180369123816490e-01) -
         ((half_square - (s * (half_square + r) + k * L(1.90821492927058770002e-10))) - f);
}

/// e^x; error about 1 ulp. 0 below -708; above 709 the value at 709. Source: fdlibm, e_exp.c.
template <class L> L exp_lane(const L& x) {
  const L y = xsimd::min(xsimd::max(x, L(-708.0)), L(709.0));
  // Rounds to the nearest integer and leaves it in the low bits of the significand.
  const L magic = y * L(1.44269504088896338700) + L(0x1.8p52);
  const L k = magic - L(0x1.8p52);
  const L high = y - k * L(6.93147180369123816490e-01), low = k * L(1.90821492927058770002e-10);
  const L r = high - low, t = r * r;
  constexpr double c[] = {1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05,
                          -1.65339022054652515390e-06, 4.13813679705723846039e-08};
  const L q = r - t * polynomial(t, c);
  const L e = L(1.0) - ((low - (r * q) / (L(2.0) - q)) - high);
  // Two factors, because 2^1024 is no number.
  const Bits<L> scale = (bits_of(magic) + Bits<L>(std::uint64_t{1022})) << 52;
  return xsimd::select(x < L(-708.0), L(0.0), e * lanes_of<L>(scale) * L(2.0));
}

/// sin(x) for |x| <= pi/4; error below 1 ulp. Source: fdlibm, k_sin.c.
template <class L> L small_sine(const L& x) {
  constexpr double c[] = {-1.66666666666666324348e-01, 8.33333333332248946124e-03,  -1.98412698298579493134e-04,
                          2.75573137070700676789e-06,  -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  const L z = x * x;
  return x + x * z * polynomial(z, c);
}

/// cos(x) for |x| <= pi/4; error below 1 ulp. Source: fdlibm, k_cos.c.
template <class L> L small_cosine(const L& x) {
  constexpr double c[] = {4.16666666666666019037e-02,  -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                          -2.75573143513906633035e-07, 2.08757232129817482790e-09,  -1.13596475577881948265e-11};
  const L z = x * x, half = L(0.5) * z, w = L(1.0) - half;
  return w + (((L(1.0) - w) - half) + z * z * polynomial(z, c));
}

template <class L> struct SineCosine { L sine, cosine; };
/// sin(x) and cos(x); error about 1 ulp for |x| < 1e6, growing with |x| beyond. The argument is reduced by multiples of
/// pi/2, which is held in three parts (Cody and Waite), always in the same way.
template <class L> SineCosine<L> sine_cosine_lane(const L& x) {
  const L magic = x * L(6.36619772367581382433e-01) + L(0x1.8p52);
  const L k = magic - L(0x1.8p52);
  const L head = x - k * L(1.57079632673412561417e+00), part = k * L(6.07710050630396597660e-11);
  const L r = head - part, rest = ((head - r) - part) - k * L(2.02226624871116645580e-21);
  const L s0 = small_sine(r), c0 = small_cosine(r);
  const L s = s0 + c0 * rest, c = c0 - s0 * rest;
  const Bits<L> quadrant = bits_of(magic);
  const auto swap = to_double<L>(quadrant & Bits<L>(std::uint64_t{1})) > L(0.5);
  const Bits<L> sine_sign = (quadrant & Bits<L>(std::uint64_t{2})) << 62;
  const Bits<L> cosine_sign = ((quadrant + Bits<L>(std::uint64_t{1})) & Bits<L>(std::uint64_t{2})) << 62;
  return {lanes_of<L>(bits_of(xsimd::select(swap, c, s)) ^ sine_sign),
          lanes_of<L>(bits_of(xsimd::select(swap, s, c)) ^ cosine_sign)};
}

/// |p - 1/2| up to which normal_quantile_centre() holds.
inline constexpr double normal_centre = 0.425;
/// Quantile of the standard normal distribution in its centre, by centred = p - 1/2; relative error about 1e-16.
/// Source: Wichura 1988, algorithm AS 241, PPND16.
template <class L> L normal_quantile_centre(const L& centred) {
  constexpr double a[] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                          1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                          3.3430575583588128105e+4, 2.5090809287301226727e+3};
  constexpr double b[] = {1.0,
                          4.2313330701600911252e+1,
                          6.8718700749205790830e+2,
                          5.3941960214247511077e+3,
                          2.1213794301586595867e+4,
                          3.9307895800092710610e+4,
                          2.8729085735721942674e+4,
                          5.2264952788528545610e+3};
  const L r = L(0.180625) - centred * centred;
  return centred * polynomial(r, a) / polynomial(r, b);
}

/// The same beyond the centre.
/// @param smaller  of p and 1 - p
/// @param centred  p - 1/2, of which the sign counts
template <class L> L normal_quantile_tail(const L& smaller, const L& centred) {
  constexpr double c[] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                          3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                          2.27238449892691845833e-2, 7.74545014278341407640e-4};
  constexpr double d[] = {1.0,
                          2.05319162663775882187e0,
                          1.67638483018380384940e0,
                          6.89767334985100004550e-1,
                          1.48103976427480074590e-1,
                          1.51986665636164571966e-2,
                          5.47593808499534494600e-4,
                          1.05075007164441684324e-9};
  constexpr double e[] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                          2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                          2.71155556874348757815e-5, 2.01033439929228813265e-7};
  constexpr double f[] = {1.0,
                          5.99832206555887937690e-1,
                          1.36929880922735805310e-1,
                          1.48753612908506148525e-2,
                          7.86869131145613259100e-4,
                          1.84631831751005468180e-5,
                          1.42151175831644588870e-7,
                          2.04426310338993978564e-15};
  const L r = xsimd::sqrt(-log_lane(smaller)), r1 = r - L(1.6);
  L size = polynomial(r1, c) / polynomial(r1, d);
  const auto far = r > L(5.0);
  if (xsimd::any(far)) {
    const L r2 = r - L(5.0);
    size = xsimd::select(far, polynomial(r2, e) / polynomial(r2, f), size);
  }
  return xsimd::select(centred < L(0.0), -size, size);
}

/// Quantile of the standard normal distribution.
///
/// @param p probability, 0 < p < 1
/// @param q 1 - p; given separately, so that a probability close to 1 keeps its digits (a tail reads the smaller one)
/// @return  z with P(Z <= z) = p; relative error about 1e-16
/// Source: as its two parts.
template <class L> L normal_quantile_lane(const L& p, const L& q) {
  const L centred = p - L(0.5);
  const auto central = xsimd::abs(centred) <= L(normal_centre);
  const L middle = normal_quantile_centre(centred);
  if (xsimd::all(central)) return middle;
  return xsimd::select(central, middle, normal_quantile_tail(xsimd::min(p, q), centred));
}

/// Distribution function of the standard normal distribution, P(Z <= x).
///
/// The relative error is a few 1e-16, in the lower tail down to x = -37 as well. (1 + y) e^(y^2/2) P(-y) is a smooth
/// function of t = (y - K)/(y + K) for all y >= 0; the polynomial in t was fitted with 50 digits at Chebyshev nodes.
/// Source of the idea: Shepherd and Laframboise 1981.
template <class L> L normal_probability_lane(const L& x) {
  constexpr double c[] = {
      0.475186245768402726,    -0.0974115047988136183,   0.00785948986281233797,    0.0334505996382925114,
      -0.0318129445578718536,  0.0144860422339750484,    -0.00220808750761958834,   -0.00114010812505416919,
      0.000521189130700184789, 0.0000980356216268234232, -0.0000873586521501072917, -0.0000148855665601466265,
      0.000014687834766676805, 3.83815809136587493e-6,   -2.3569047107127891e-6,    -1.11990068621227176e-6,
      2.80614983649517884e-7,  2.99198214084741211e-7,   6.91139573003117157e-9,    -6.57857633811990421e-8,
      -1.65094597596316962e-8, 1.03956196217943552e-8,   4.7785338949739182e-9,     -8.68225591666153629e-10,
      -5.69066843597446487e-10};
  const L y = xsimd::min(xsimd::abs(x), L(38.5));
  const L t = (y - L(3.75)) / (y + L(3.75));
  // y^2 in two parts, because its rounding error would be multiplied by y^2.
  const L head = lanes_of<L>(bits_of(y) & Bits<L>(~std::uint64_t{0x7ffffff}));
  const L rest = L(0.5) * (y - head) * (y + head);
  const L tail =
      polynomial(t, c) / (L(1.0) + y) * exp_lane(L(-0.5) * head * head) * (L(1.0) - rest + L(0.5) * rest * rest);
  return xsimd::select(x < L(0.0), tail, L(1.0) - tail);
}

} // namespace gumshoe
