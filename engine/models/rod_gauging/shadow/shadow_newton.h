#pragma once
/// Fast trigger solve for the common case: both ends of the covered chord lie on the smooth part of
/// the rod's lower edge. One joint Newton iteration in (left end, right end, height), lane by lane;
/// a lane that it cannot take says so and goes to the general solver (shadow_boundary.h).
#include <numbers>

#include "models/rod_gauging/shadow/shadow.h"

namespace gumshoe::models::rod_gauging {

/// Chord ends as sin w, and the edge's height; V is double or Lanes.
template <class V> struct ChordSolve {
  V left, right, k;
  V failed; ///< 1 where the general solver must take over, else 0
};

namespace detail {
/// Gauss-Legendre, 4 nodes on [-1, 1].
inline constexpr double gauss4_node[2] = {0.33998104358485626, 0.86113631159405258};
inline constexpr double gauss4_weight[2] = {0.65214515486254614, 0.34785484513745386};
} // namespace detail

/// Covered area, by Green's theorem over the circle's arc and the edge: with X the boundary,
/// 2 area = R^2 alpha + integral of X x dX, where X x P' = depth rho + fillet n + side tz - k ty.
/// Off the solution the boundary is closed by radial slivers, so the error is of second order.
template <class V> ChordSolve<V> solve_chord(const ShadowEdge<V>& e, const V& beam_radius, const V& fraction) {
  const V r2 = beam_radius * beam_radius;
  const V target = fraction * (std::numbers::pi * r2);

  // Start from the tangent at w = 0: a straight edge at distance R sin(beta) from the beam's centre.
  const V x = 0.5 * std::numbers::pi * (0.5 - fraction);
  const V beta = x * (1.0 + x * x * (1.0 / 3.0));
  const V q = num::sqrt(1.0 + e.shear * e.shear);
  const V distance = beam_radius * beta * (1.0 - beta * beta * (1.0 / 6.0));
  const V half = num::sqrt(num::select(distance * distance < r2, r2 - distance * distance, r2));
  const V inverse = 1.0 / (q * e.rho);
  const V middle = -(distance + e.fillet) * e.shear - e.side * q;
  V s1 = (middle - half) * inverse;
  V s2 = (middle + half) * inverse;
  V k = distance * q + e.shear * e.side + e.depth + e.fillet * q;

  V active = V(1.0);
  for (int iteration = 0; iteration < 8; ++iteration) {
    const V c1 = num::sqrt(1.0 - s1 * s1), c2 = num::sqrt(1.0 - s2 * s2);
    const EdgePoint<V> a = edge_point(e, s1, c1), b = edge_point(e, s2, c2);
    const V za = a.z + k, zb = b.z + k;
    const V cross = b.y * za - zb * a.y, dot = a.y * b.y + za * zb;
    const V alpha = std::numbers::pi + num::atan2(-cross, -dot);

    const V mid = 0.5 * (s1 + s2), span = 0.5 * (s2 - s1);
    const V swept = e.depth * e.rho;
    V sum = V(0.0);
    for (int i = 0; i < 2; ++i)
      for (const double side : {-1.0, 1.0}) {
        const V s = mid + (side * detail::gauss4_node[i]) * span;
        const V c = num::sqrt(1.0 - s * s);
        const V ty = e.rho * c, tz = e.shear * ty + e.depth * s;
        const V n2 = ty * ty + tz * tz, n = num::sqrt(n2), n3 = n2 * n;
        const V integrand = (swept + e.fillet * n + e.side * tz - k * ty) * (n3 + e.fillet * swept) / (n3 * c);
        sum = sum + detail::gauss4_weight[i] * integrand;
      }
    const V area = 0.5 * (r2 * alpha + sum * span);

    const V dk = (area - target) / (b.y - a.y);
    const V d1 = -(a.y * a.y + za * za - r2 + 2.0 * za * dk) * c1 / (2.0 * (a.y * a.ty + za * a.tz) * a.growth);
    const V d2 = -(b.y * b.y + zb * zb - r2 + 2.0 * zb * dk) * c2 / (2.0 * (b.y * b.ty + zb * b.tz) * b.growth);
    const auto moving = active > V(0.5);
    k = num::select(moving, k + dk, k);
    s1 = num::select(moving, s1 + d1, s1);
    s2 = num::select(moving, s2 + d2, s2);
    // Newton squares the error: after a step below 1e-7 radii the next would be below 1e-13.
    const V step = num::abs(dk) + e.rho * (num::abs(d1) + num::abs(d2));
    active = num::select(step > 1e-7 * beam_radius, active, V(0.0));
    // A lane that left the smooth part, or became NaN, is given up.
    const V widest = num::select(num::abs(s1) > num::abs(s2), num::abs(s1), num::abs(s2));
    active = num::select(widest < V(0.4), active, num::select(active > V(0.5), V(-1.0), active));
    if (!num::any(active > V(0.5))) break;
  }

  // Accept where converged and the 4-node rule is good for 1e-14 m: its error is below
  // 0.01 (depth + fillet kappa) a^8 for |s| <= a, the nearest singularities being at |s| = 1 / max(1, kappa).
  const V kappa = e.depth / e.rho;
  const V widest = num::select(num::abs(s1) > num::abs(s2), num::abs(s1), num::abs(s2));
  const V a = widest * num::select(kappa > V(1.0), kappa, V(1.0));
  const V a2 = a * a, a4 = a2 * a2;
  const V rule_error = 0.01 * (e.depth + e.fillet * kappa) * (a4 * a4);
  ChordSolve<V> result{s1, s2, k, V(1.0)};
  auto good = (active > V(-0.5)) && (active < V(0.5)) && (rule_error < V(1e-14)) && (widest < V(0.4)) && (s1 < s2);
  result.failed = num::select(good, V(0.0), V(1.0));
  return result;
}

} // namespace gumshoe::models::rod_gauging
