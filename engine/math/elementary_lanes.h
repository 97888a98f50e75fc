#pragma once
/// Elementary functions over their whole range, lane by lane, with the conventions of the C library: the result of a NaN
/// is a NaN, a pole is infinite, and outside the domain the result is a NaN. Errors are a few units in the last place.
/// They are built from lane_functions.h, so that the bits depend neither on the instruction set nor on neighbouring
/// lanes. elementary.h offers them for every scalar and has the table of domains.
#include "base/special_values.h"
#include "math/lane_functions.h"

namespace gumshoe::elementary {

template <class L> L sqrt_lane(const L& x) { return xsimd::sqrt(x); }

/// Where `mask` holds the C library's value f(x), else `otherwise`. f is evaluated lane by lane: keep the mask rare.
template <class L, class Mask, class F> L replaced(const Mask& mask, const L& x, const L& otherwise, const F& f) {
  if (!xsimd::any(mask)) return otherwise;
  alignas(64) double in[L::size], out[L::size];
  x.store_aligned(in);
  for (double& v : in) v = f(v);
  for (std::size_t i = 0; i < L::size; ++i) out[i] = in[i];
  return xsimd::select(mask, L::load_aligned(out), otherwise);
}
/// Mask of the arguments for which the argument reduction of sine_cosine_lane loses digits: |x| >= 1e6, NaN.
template <class L> auto far(const L& x) { return !(xsimd::abs(x) < L(1e6)); }

template <class L> L sin_lane(const L& x) {
  return replaced(far(x), x, sine_cosine_lane(x).sine, [](double v) { return std::sin(v); });
}
template <class L> L cos_lane(const L& x) {
  return replaced(far(x), x, sine_cosine_lane(x).cosine, [](double v) { return std::cos(v); });
}
template <class L> L tan_lane(const L& x) {
  const auto both = sine_cosine_lane(x);
  return replaced(far(x), x, both.sine / both.cosine, [](double v) { return std::tan(v); });
}

/// e^x; zero below -708 and infinite above 709, slightly inside the range of a double.
template <class L> L exp_whole_lane(const L& x) {
  const L e = xsimd::select(x > L(709.0), L(infinity), exp_lane(x));
  return xsimd::select(x == x, e, x);
}

/// Completes a logarithm at and below zero, and at infinity.
template <class L> L outside_of_log(const L& x, const L& inside) {
  L y = xsimd::select(x > L(0.0), inside, L(nan));
  y = xsimd::select(x == L(0.0), L(-infinity), y);
  return xsimd::select(x == L(infinity), x, y);
}
template <class L> L log_whole_lane(const L& x) { return outside_of_log(x, log_lane(x)); }

/// An unevaluated sum head + rest with |rest| at most half a unit in the last place of head: about twice the digits.
template <class L> struct Pair { L head, rest; };
/// a + b without error, for any two numbers. Source: Knuth, TAOCP 2, section 4.2.2.
template <class L> Pair<L> exact_sum(const L& a, const L& b) {
  const L s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
/// a b without error, for |a|, |b| below 2^996. Source: Dekker 1971.
template <class L> Pair<L> exact_product(const L& a, const L& b) {
  const L split(134217729.0), ca = split * a, cb = split * b;
  const L ah = ca - (ca - a), al = a - ah, bh = cb - (cb - b), bl = b - bh;
  const L p = a * b;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

/// Natural logarithm of a positive number to about 64 bits, for pow and log10: the series of 2 atanh((m - 1)/(m + 1)) with
/// its first two terms in two doubles each.
template <class L> Pair<L> log_pair_lane(L x) {
  const auto tiny = x < L(0x1p-1022);
  x = xsimd::select(tiny, x * L(0x1p54), x);
  const Bits<L> shifted = bits_of(x) + Bits<L>(std::uint64_t{0x3ff0000000000000u - 0x3fe6a09e00000000u});
  const L k = to_double<L>(shifted >> 52) - xsimd::select(tiny, L(1023.0 + 54.0), L(1023.0));
  const L m = lanes_of<L>((shifted & Bits<L>(std::uint64_t{0x000fffffffffffffu})) +
                          Bits<L>(std::uint64_t{0x3fe6a09e00000000u}));
  const L f = m - L(1.0);
  const auto below = exact_sum(m, L(1.0));
  const L s = f / below.head;
  const auto back = exact_product(s, below.head);
  const L s_rest = (((f - back.head) - back.rest) - s * below.rest) / below.head;
  auto square = exact_product(s, s);
  square.rest = square.rest + L(2.0) * s * s_rest;
  auto cube = exact_product(square.head, s);
  cube.rest = cube.rest + square.head * s_rest + square.rest * s;
  constexpr double third = 2.0 / 3, third_rest = 3.70074341541718826e-17; // 2/3 - third
  auto second = exact_product(cube.head, L(third));
  second.rest = second.rest + cube.rest * L(third) + cube.head * L(third_rest);
  // 2 s^5 (1/5 + s^2/7 + ...); s < 0.1716
  constexpr double c[] = {2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13, 2.0 / 15,
                          2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23, 2.0 / 25};
  const L third_term = cube.head * square.head * polynomial(square.head, c);
  const auto a = exact_sum(L(2.0) * s, second.head);
  const auto b = exact_sum(k * L(6.93147180369123816490e-01), a.head);
  const L rest = b.rest + (a.rest + (second.rest + L(2.0) * s_rest + third_term + k * L(1.90821492927058770002e-10)));
  const L head = b.head + rest;
  return {head, rest - (head - b.head)};
}

/// Decimal logarithm; exact for powers of ten, because the product is formed in pairs and rounded once.
template <class L> L log10_lane(const L& x) {
  constexpr double c = 4.34294481903251816668e-01, c_rest = 1.09831965021676508e-17; // 1/ln 10
  const auto l = log_pair_lane(x);
  const auto p = exact_product(l.head, L(c));
  return outside_of_log(x, p.head + (p.rest + (l.rest * L(c) + l.head * L(c_rest))));
}

/// Mask of whole numbers; every |y| >= 2^51 counts as one.
template <class L> auto whole(const L& y) {
  return (xsimd::abs(y) >= L(0x1p51)) || ((y + L(0x1.8p52)) - L(0x1.8p52) == y);
}
/// x^y; for negative x only if y is a whole number, else NaN; 0^0 = 1.
template <class L> L pow_lane(const L& x, const L& given) {
  const L y = xsimd::min(xsimd::max(given, L(-1e100)), L(1e100)), size = xsimd::abs(x);
  const auto plain = (size > L(0.0)) && (size < L(infinity));
  const auto l = log_pair_lane(xsimd::select(plain, size, L(1.0)));
  const auto p = exact_product(y, l.head);
  const L e = exp_whole_lane(p.head), rest = p.rest + y * l.rest;
  L r = xsimd::select((e > L(0.0)) && (e < L(infinity)), e + e * rest, e);
  const L at_end = xsimd::select((size == L(0.0)) == (y > L(0.0)), L(0.0), L(infinity));
  r = xsimd::select(plain, r, at_end);
  const auto odd = whole(y) && !whole(L(0.5) * y);
  r = xsimd::select((x < L(0.0)) && odd, -r, r);
  r = xsimd::select((x < L(0.0)) && !whole(y), L(nan), r);
  r = xsimd::select((x == x) && (given == given), r, L(nan));
  return xsimd::select(given == L(0.0), L(1.0), r);
}

/// Arc tangent of x >= 0, rad: expanded about 0, 1/2, 1, 3/2 or infinity. Source: fdlibm, s_atan.c.
template <class L> L positive_atan(const L& x) {
  const auto above_0 = x >= L(0.4375), above_1 = x >= L(0.6875), above_2 = x >= L(1.1875), above_3 = x >= L(2.4375);
  const auto choose = [&](const L& v0, double v1, double v2, double v3, double v4) {
    L v = xsimd::select(above_0, L(v1), v0);
    v = xsimd::select(above_1, L(v2), v);
    v = xsimd::select(above_2, L(v3), v);
    return xsimd::select(above_3, L(v4), v);
  };
  // tan(atan x - atan c) = (x - c) / (1 + c x); for c infinite -1/x
  const L c = choose(L(0.0), 0.5, 1.0, 1.5, 0.0);
  const L t = xsimd::select(above_3, L(-1.0) / x, (x - c) / (L(1.0) + c * x));
  const L head = choose(L(0.0), 4.63647609000806093515e-01, 7.85398163397448278999e-01, 9.82793723247329054082e-01,
                        1.57079632679489655800e+00);
  const L rest = choose(L(0.0), 2.26987774529616870924e-17, 3.06161699786838301793e-17, 1.39033110312309984516e-17,
                        6.12323399573676603587e-17);
  constexpr double p[] = {3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
                          -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
                          6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
                          -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  const L z = t * t;
  return head - ((t * (z * polynomial(z, p)) - rest) - t);
}
/// `size` with the sign of `sign`, zeros included; size >= 0.
template <class L> L signed_as(const L& size, const L& sign) {
  return lanes_of<L>(bits_of(size) | (bits_of(sign) & Bits<L>(std::uint64_t{0x8000000000000000u})));
}
template <class L> L atan_lane(const L& x) { return signed_as(positive_atan(xsimd::abs(x)), x); }
template <class L> L asin_lane(const L& x) { return atan_lane(x / xsimd::sqrt((L(1.0) - x) * (L(1.0) + x))); }
template <class L> L acos_lane(const L& x) { return L(2.0) * positive_atan(xsimd::sqrt((L(1.0) - x) / (L(1.0) + x))); }
/// Angle of the point (x, y), rad, in (-pi, pi]; 0 at the origin.
template <class L> L atan2_lane(const L& y, const L& x) {
  const L ratio = xsimd::select((x == L(0.0)) && (y == L(0.0)), L(0.0), xsimd::abs(y) / xsimd::abs(x));
  const L t = positive_atan(ratio);
  const L turned = xsimd::select(x < L(0.0), L(3.14159265358979311600e+00) - (t - L(1.22464679914735317723e-16)), t);
  return signed_as(turned, y);
}

/// Hyperbolic sine: its series for |x| < 1, exponentials above.
template <class L> L sinh_lane(const L& x) {
  const L size = xsimd::abs(x), e = exp_whole_lane(size), z = x * x;
  constexpr double c[] = {1.0 / 6,
                          1.0 / 120,
                          1.0 / 5040,
                          1.0 / 362880,
                          1.0 / 39916800,
                          1.0 / 6227020800.0,
                          1.0 / 1307674368000.0,
                          1.0 / 355687428096000.0,
                          1.0 / 121645100408832000.0};
  return xsimd::select(size < L(1.0), x + x * z * polynomial(z, c), signed_as(L(0.5) * e - L(0.5) / e, x));
}
template <class L> L cosh_lane(const L& x) {
  const L e = exp_whole_lane(xsimd::abs(x));
  return L(0.5) * e + L(0.5) / e;
}
template <class L> L tanh_lane(const L& x) {
  const L size = xsimd::abs(x);
  const L large = signed_as(L(1.0) - L(2.0) / (exp_whole_lane(L(2.0) * size) + L(1.0)), x);
  const L small = xsimd::min(size, L(1.0));
  return xsimd::select(size < L(1.0), sinh_lane(signed_as(small, x)) / cosh_lane(small), large);
}

/// sqrt(x^2 + y^2) without overflow of the squares.
template <class L> L hypot_lane(const L& x, const L& y) {
  const L a = xsimd::abs(x), b = xsimd::abs(y);
  const L most = xsimd::select(a > b, a, b), least = xsimd::select(a > b, b, a), r = least / most;
  return xsimd::select(most == L(0.0), L(0.0), most * xsimd::sqrt(L(1.0) + r * r));
}
/// The smaller, the larger of two; NaN if either is NaN.
template <class L> L min_lane(const L& x, const L& y) {
  return xsimd::select(x <= y, x, xsimd::select(y == y, xsimd::select(x == x, y, x), y));
}
template <class L> L max_lane(const L& x, const L& y) {
  return xsimd::select(x >= y, x, xsimd::select(y == y, xsimd::select(x == x, y, x), y));
}

} // namespace gumshoe::elementary
