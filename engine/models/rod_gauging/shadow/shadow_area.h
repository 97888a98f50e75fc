#pragma once
/// Points and path integrals on the shadow's boundary, in any scalar.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/rod_gauging/shadow/shadow_boundary.h"
#include "math/quadrature.h"

namespace gumshoe::models::rod_gauging {

inline constexpr double pi = std::numbers::pi;

/// pi/2 to the digits of T, so that angles measured from either end of the half-ellipse fit together.
template <class T> T half_pi() { return T(0.5 * pi); }
template <> inline long double half_pi<long double>() { return 1.57079632679489661923132169163975L; }

/// A boundary point with what the path integral needs. On a wall only y and z hold.
template <class T> struct BoundaryPoint {
  T y, z;   ///< at height k
  T w, nu;  ///< position on the half-ellipse, and angle of the edge's direction
  T moment; ///< P x N
  T dy, dz; ///< derivative by the piece's parameter
};

inline bool is_wall(Piece p) { return p == Piece::left_wall || p == Piece::right_wall; }
inline bool is_left(Piece p) { return p <= Piece::left_quarter; }

/// The point of a piece at its parameter t (Crossing), with the edge at height k, m.
template <class T> BoundaryPoint<T> boundary_point(const ShadowEdge<T>& e, const T& k, Piece piece, const T& t) {
  const double sign = is_left(piece) ? -1.0 : 1.0;
  BoundaryPoint<T> p{};
  if (is_wall(piece)) {
    p.y = e.side + sign * (e.rho + e.fillet);
    p.z = t;
    p.dy = T(0.0);
    p.dz = T(1.0);
    return p;
  }
  const bool fan = piece == Piece::left_fan || piece == Piece::right_fan;
  T py, pz, normal_y, normal_z;
  if (fan) {
    py = sign * e.rho;
    pz = e.shear * py;
    normal_y = num::sin(t);
    normal_z = -num::cos(t);
    p.w = sign * half_pi<T>();
    p.nu = t;
    p.dy = -(e.fillet * normal_z);
    p.dz = e.fillet * normal_y;
  } else {
    const T sin_w = sign * num::cos(t), cos_w = num::sin(t);
    const EdgePoint<T> q = edge_point(e, sin_w, cos_w);
    py = e.rho * sin_w;
    pz = e.shear * py - e.depth * cos_w;
    normal_y = q.tz / q.n;
    normal_z = -(q.ty / q.n);
    p.w = sign * (half_pi<T>() - t);
    p.nu = num::atan2(q.tz, q.ty);
    p.dy = -sign * (q.growth * q.ty);
    p.dz = -sign * (q.growth * q.tz);
  }
  p.moment = py * normal_z - pz * normal_y;
  p.y = py + e.fillet * normal_y + e.side;
  p.z = pz + e.fillet * normal_z + k;
  return p;
}

/// Arc length of the half-ellipse between w = a and b. The integrand's singularities lie at distance
/// `pinch_width` from the directions `pinch` + m pi, where the ellipse turns fastest: panels of 12
/// nodes are halved until none is longer than its distance to them (error below 1e-14).
template <class T> class ArcLength {
public:
  explicit ArcLength(const ShadowEdge<T>& e) : edge_(e) {
    const double ry = num::value(e.rho), sz = num::value(e.shear) * ry, d = num::value(e.depth);
    // n^2 = a cos^2 w + 2 b sin w cos w + c sin^2 w
    const double a = ry * ry + sz * sz, b = sz * d, c = d * d;
    const double mean = 0.5 * (a + c), swing = std::hypot(0.5 * (a - c), b);
    pinch_ = 0.5 * std::atan2(b, 0.5 * (a - c)) + 0.5 * pi;    // where n is least
    const double least = (ry * d) * (ry * d) / (mean + swing); // product of the eigenvalues is (rho depth)^2
    width_ = mean + swing > 0 ? std::sqrt(least / (mean + swing)) : 1.0;
  }
  T operator()(const T& a, const T& b) const { return panel(a, b, 0); }

private:
  T panel(const T& a, const T& b, int level) const {
    const double lo = num::value(a), hi = num::value(b), length = hi - lo;
    if (length > 1e-9 && level < 60 && distance(lo, hi) < length) {
      const T mid(0.5 * (lo + hi));
      return panel(a, mid, level + 1) + panel(mid, b, level + 1);
    }
    const auto& rule = math::GaussLegendre<12>::rule();
    const T half = 0.5 * (b - a), mid = 0.5 * (a + b);
    T sum = T(0.0);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const T w = mid + rule.node[i] * half;
      const T cos_w = num::cos(w);
      const T ty = edge_.rho * cos_w, tz = edge_.shear * ty + edge_.depth * num::sin(w);
      sum = sum + rule.weight[i] * num::sqrt(ty * ty + tz * tz);
    }
    return sum * half;
  }
  double distance(double lo, double hi) const {
    const double mid = 0.5 * (lo + hi);
    const double nearest = pinch_ + pi * std::round((mid - pinch_) / pi);
    const double outside = std::max({0.0, lo - nearest, nearest - hi});
    return std::hypot(outside, width_);
  }
  const ShadowEdge<T>& edge_;
  double pinch_ = 0, width_ = 0;
};

/// Integral of X x dX along the boundary from one crossing to the next, and the advance in y on the edge.
/// On the edge: depth rho dw + 2 fillet ds + fillet [P x N] + fillet^2 dnu + shift x [X] (Steiner's
/// formula for parallel curves); on a wall: y dz.
template <class T> struct PathIntegral {
  T twice_area = T(0.0);
  T chord = T(0.0);
};
template <class T>
PathIntegral<T> path_integral(const ShadowEdge<T>& e, const T& k, const ArcLength<T>& arc, const Crossing& from,
                              const BoundaryPoint<T>& a, const Crossing& to, const BoundaryPoint<T>& b) {
  PathIntegral<T> result;
  const bool starts_on_wall = is_wall(from.piece), ends_on_wall = is_wall(to.piece);
  if (starts_on_wall && from.piece == to.piece) {
    result.twice_area = a.y * (b.z - a.z);
    return result;
  }
  const BoundaryPoint<T> first = starts_on_wall ? boundary_point(e, k, Piece::left_fan, T(-0.5 * pi)) : a;
  const BoundaryPoint<T> last = ends_on_wall ? boundary_point(e, k, Piece::right_fan, T(0.5 * pi)) : b;
  if (starts_on_wall) result.twice_area += a.y * (first.z - a.z);
  if (ends_on_wall) result.twice_area += b.y * (b.z - last.z);
  T edge = e.fillet * (last.moment - first.moment) + e.fillet * e.fillet * (last.nu - first.nu) +
           e.side * (last.z - first.z) - k * (last.y - first.y);
  if (num::value(e.rho) > 0 && num::value(last.w) > num::value(first.w))
    edge += e.depth * e.rho * (last.w - first.w) + 2.0 * e.fillet * arc(first.w, last.w);
  result.twice_area += edge;
  result.chord = last.y - first.y;
  return result;
}

/// Angle from a to b about the origin, counter-clockwise, in [0, 2 pi).
template <class T> T angle_between(const BoundaryPoint<T>& a, const BoundaryPoint<T>& b) {
  const T angle = num::atan2(a.y * b.z - a.z * b.y, a.y * b.y + a.z * b.z);
  return num::value(angle) < 0 ? angle + 2 * pi : angle;
}

template <class T>
Covered<T> covered(const ShadowEdge<T>& e, const T& k, const T& beam_radius, const std::vector<Crossing>& crossings,
                   const std::vector<T>& t) {
  const ArcLength<T> arc(e);
  const std::size_t n = crossings.size();
  std::vector<BoundaryPoint<T>> points(n);
  for (std::size_t i = 0; i < n; ++i) points[i] = boundary_point(e, k, crossings[i].piece, t[i]);
  T twice_area = T(0.0), chord = T(0.0);
  for (std::size_t i = 0; i < n; i += 2) {
    const auto path = path_integral(e, k, arc, crossings[i], points[i], crossings[i + 1], points[i + 1]);
    twice_area += path.twice_area + beam_radius * beam_radius * angle_between(points[i + 1], points[(i + 2) % n]);
    chord += path.chord;
  }
  return {0.5 * twice_area, chord};
}

template <class T>
T refine_height(const ShadowEdge<T>& e, const T& beam_radius, const T& fraction, const BoundarySolve& solved) {
  T k(solved.k);
  std::vector<T> t;
  for (const Crossing& c : solved.crossings) t.push_back(T(c.t));
  for (int level = 0; level < num::derivative_levels<T>; ++level) {
    for (std::size_t i = 0; i < t.size(); ++i) {
      const auto p = boundary_point(e, k, solved.crossings[i].piece, t[i]);
      t[i] -= (p.y * p.y + p.z * p.z - beam_radius * beam_radius) / (2.0 * (p.y * p.dy + p.z * p.dz));
    }
    const auto c = covered(e, k, beam_radius, solved.crossings, t);
    k += (c.area - pi * beam_radius * beam_radius * fraction) / c.chord;
  }
  return k;
}

} // namespace gumshoe::models::rod_gauging
