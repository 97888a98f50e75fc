#include "references/rod_brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace gumshoe::references {
namespace {

using real = long double;
constexpr real pi = std::numbers::pi_v<real>;

using Vector = std::array<real, 3>;
real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector at(const Vector& p, real length, const Vector& direction) {
  return {p[0] + length * direction[0], p[1] + length * direction[1], p[2] + length * direction[2]};
}

struct Point {
  real y, z;
};
using Polygon = std::vector<Point>;
real cross(Point a, Point b) { return a.y * b.z - a.z * b.y; }
Point operator-(Point a, Point b) { return {a.y - b.y, a.z - b.z}; }
Point operator+(Point a, Point b) { return {a.y + b.y, a.z + b.z}; }

/// Counter-clockwise from the leftmost lowest point (Andrew's monotone chain).
Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(), [](Point a, Point b) { return a.y < b.y || (a.y == b.y && a.z < b.z); });
  Polygon hull;
  const auto add = [&hull](Point p, std::size_t keep) {
    while (hull.size() >= keep + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (Point p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

/// A convex polygon plus the polygon inscribed in a disc: their edges merged by direction.
Polygon dilated(const Polygon& hull, real radius, int sides) {
  if (radius == 0) return hull;
  std::vector<std::pair<real, Point>> edges;
  const auto push = [&edges](Point e) {
    if (e.y != 0 || e.z != 0) edges.emplace_back(std::atan2(e.z, e.y), e);
  };
  for (std::size_t i = 0; i < hull.size(); ++i) push(hull[(i + 1) % hull.size()] - hull[i]);
  const auto corner = [&](int k) {
    return Point{radius * std::cos(2 * pi * k / sides), radius * std::sin(2 * pi * k / sides)};
  };
  for (int k = 0; k < sides; ++k) push(corner(k + 1) - corner(k));
  std::stable_sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.first < b.first; });

  Polygon sum{{0, 0}};
  for (const auto& [angle, edge] : edges) sum.push_back(sum.back() + edge);
  sum.pop_back();
  // With sides a multiple of four the disc has corners at its left and at its bottom: they place the sum.
  const auto left = [](Point a, Point b) { return a.y < b.y; };
  const auto below = [](Point a, Point b) { return a.z < b.z; };
  const auto placed = [&](const Polygon& p) {
    return Point{std::min_element(p.begin(), p.end(), left)->y, std::min_element(p.begin(), p.end(), below)->z};
  };
  const Point shift = placed(hull) - placed(sum) - Point{radius, radius};
  for (Point& p : sum) p = p + shift;
  return sum;
}

/// Shadow at Z_d = 0, and how far the true shadow can reach beyond its polygon.
struct Shadow {
  Polygon polygon;
  real gap;
  real extent; ///< the lower edge lies within this of the axis' height
};

Shadow shadow_of(const RodCase& rod, int samples, Construction construction) {
  const real R = rod.rod_radius, r = rod.fillet_radius, phi = rod.bottom_elevation;
  const real theta = rod.holder_angle, tau = rod.bottom_azimuth, a = rod.beam_yaw, b = rod.beam_pitch;
  const auto turned = [theta](Vector p) {
    return Vector{p[0] * std::cos(theta) - p[1] * std::sin(theta), p[0] * std::sin(theta) + p[1] * std::cos(theta),
                  p[2]};
  };
  const auto projected = [a, b](Vector p) {
    return Point{-p[0] * std::sin(a) + p[1] * std::cos(a),
                 -std::sin(b) * (p[0] * std::cos(a) + p[1] * std::sin(a)) + p[2] * std::cos(b)};
  };
  const Vector bottom{std::cos(phi) * std::cos(tau), std::cos(phi) * std::sin(tau), std::sin(phi)}; // eq. 2.4
  const real extent = 3 * R / std::sin(phi); // of bottom or fillet, from the bottom centre
  const real top = (3 * extent + 4 * static_cast<real>(rod.beam_radius)) / std::cos(b);
  const bool surface = construction == Construction::fillet_surface;

  Polygon points; // an infinite rod needs to reach only past the beam
  for (int i = 0; i < samples; ++i) {
    const real u = 2 * pi * i / samples;
    const Vector outward{std::cos(u), std::sin(u), 0};
    // The centre lies R_f inside both the cylinder and the bottom plane.
    Vector centre = at({0, 0, 0}, R - r, outward);
    centre[2] = (r - dot(bottom, centre)) / bottom[2];
    if (!surface) {
      points.push_back(projected(turned(centre)));
      points.push_back(projected(turned({centre[0], centre[1], top})));
      continue;
    }
    points.push_back(projected(turned(at({0, 0, top}, R, outward))));
    // The arc from the flank to the bottom: normals turn from `outward` to -`bottom`.
    const real opening = std::acos(std::clamp<real>(-dot(outward, bottom), -1, 1));
    for (int j = 0; j <= samples; ++j) {
      const real v = opening * j / samples;
      Vector normal = at({0, 0, 0}, std::sin(opening - v) / std::sin(opening), outward);
      normal = at(normal, -std::sin(v) / std::sin(opening), bottom);
      points.push_back(projected(turned(at(centre, r, normal))));
    }
  }
  // Sagitta of a chord: of the (sheared) ellipse of centres, whose longest semi-axis is (R - r) / sin(phi),
  // and of the ball. A point of the surface has a sample within half a step of both angles.
  const real step = pi / samples;
  const real gap = ((R - r) / bottom[2] + (surface ? 2 : 1) * r) * (1 - std::cos(step));
  Polygon hull = convex_hull(std::move(points));
  if (!surface) hull = dilated(hull, r, (samples + 3) / 4 * 4);
  return {std::move(hull), gap, extent};
}

/// Signed area of the disc's part in the triangle (centre, p, q).
real slice(Point p, Point q, real radius) {
  const auto sector = [radius](Point s, Point t) {
    return radius * radius / 2 * std::atan2(cross(s, t), s.y * t.y + s.z * t.z);
  };
  const Point d = q - p;
  const real dd = d.y * d.y + d.z * d.z;
  if (dd == 0) return 0;
  const real middle = -(p.y * d.y + p.z * d.z) / dd, offset = cross(p, q) / std::sqrt(dd);
  const real square = (radius - offset) * (radius + offset) / dd;
  if (square <= 0) return sector(p, q);
  const real enter = std::max<real>(0, middle - std::sqrt(square)),
             leave = std::min<real>(1, middle + std::sqrt(square));
  if (enter >= leave) return sector(p, q);
  const Point in{p.y + enter * d.y, p.z + enter * d.z}, out{p.y + leave * d.y, p.z + leave * d.z};
  return (enter > 0 ? sector(p, in) : 0) + cross(in, out) / 2 + (leave < 1 ? sector(out, q) : 0);
}

real area_in_disc(const Polygon& polygon, real lift, real radius) {
  real area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    area += slice({p.y, p.z + lift}, {q.y, q.z + lift}, radius);
  }
  return area;
}

} // namespace

BruteForceHeight brute_force_bottom_height(const RodCase& rod, int samples, Construction construction) {
  const Shadow shadow = shadow_of(rod, samples, construction);
  const real radius = rod.beam_radius, target = rod.fraction * pi * radius * radius;

  // Lifts on the photodiode plane: from surely covering to surely clear.
  real low = -(shadow.extent + radius), high = shadow.extent + radius;
  if (area_in_disc(shadow.polygon, low, radius) <= target) return {std::numeric_limits<double>::quiet_NaN(), 0};
  for (int i = 0; i < 64; ++i) {
    const real lift = (low + high) / 2;
    (area_in_disc(shadow.polygon, lift, radius) > target ? low : high) = lift;
  }

  // A shadow larger by `gap` all round covers what the polygon covers plus at most gap times the boundary
  // inside the disc (no longer than the disc's own) plus gap itself. Follow the polygon until it covers that.
  const real missing = shadow.gap * 2 * pi * (radius + shadow.gap);
  real shift = shadow.gap;
  while (area_in_disc(shadow.polygon, low - shift, radius) < std::min(target + missing, pi * radius * radius) &&
         shift < radius)
    shift *= 2;
  return {static_cast<double>(low / std::cos(static_cast<real>(rod.beam_pitch))),
          static_cast<double>(shift / std::cos(static_cast<real>(rod.beam_pitch)))};
}

} // namespace gumshoe::references
