#include "references/mill_brute_force.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::tests {

namespace mill = gumshoe::tests::mill;
using gumshoe::tests::Row, gumshoe::tests::Commanded, gumshoe::tests::Stated;

namespace {

struct Vec {
  double x, y, z;
};
Vec about_z(const Vec& v, double t) {
  return {std::cos(t) * v.x - std::sin(t) * v.y, std::sin(t) * v.x + std::cos(t) * v.y, v.z};
}
Vec about_x(const Vec& v, double t) {
  return {v.x, std::cos(t) * v.y - std::sin(t) * v.z, std::sin(t) * v.y + std::cos(t) * v.z};
}

} // namespace

double covered_by_strips(const double* q, double psi, double h, int columns) {
  const double beam = q[Row::beam_radius], yaw = q[Row::beam_yaw], pitch = q[Row::beam_pitch], radius = q[Row::insert_radius];
  // A point of the insert's frame on the photodiode plane, by rotating everything instead of the beam.
  const auto turned = [&](Vec v, bool point) {
    v = about_z(about_x(v, -q[Row::insert_axial_angle]), -q[Row::insert_radial_angle]);
    if (point) v.x += q[Row::tool_radius];
    v = about_z(v, psi);
    if (point) v.y -= q[Row::offset], v.z += h;
    v = about_z(v, -yaw);
    return Vec{std::cos(pitch) * v.x + std::sin(pitch) * v.z, v.y, std::cos(pitch) * v.z - std::sin(pitch) * v.x};
  };
  const Vec front = turned({-radius, 0, radius}, true);
  const Vec back = turned({-radius, q[Row::insert_thickness], radius}, true);
  const Vec u = turned({1, 0, 0}, false), w = turned({0, 0, 1}, false);
  const double shrink = q[Row::insert_thickness] * std::tan(q[Row::clearance_angle]);
  const double amplitude = std::hypot(u.y, w.y), phase = std::atan2(w.y, u.y);
  const double along = u.z * std::cos(phase) + w.z * std::sin(phase); // dz per dy's amplitude, in phase
  const double across = w.z * std::cos(phase) - u.z * std::sin(phase);
  // Edge of the disc at share s of the thickness in column y: sign -1 the lower, +1 the upper.
  const auto edge = [&](double s, double y, double sign) {
    const double r = radius - s * shrink, c = (y - front.y - s * (back.y - front.y)) / (r * amplitude);
    return front.z + s * (back.z - front.z) +
           r * (along * std::clamp(c, -1.0, 1.0) + sign * std::fabs(across) * std::sqrt(std::max(0.0, 1 - c * c)));
  };
  double area = 0;
  for (int i = 0; i < columns; ++i) {
    // strips even in the angle, so that the disc's own edge costs nothing
    const double t = M_PI * ((i + 0.5) / columns - 0.5), y = beam * std::sin(t), half = beam * std::cos(t);
    // shares of the stack that reach the column: |y - y_s| <= r_s amplitude
    double lo = 0, hi = 1;
    for (const double sign : {-1.0, 1.0}) { // sign (y - front - s shift) <= (radius - s shrink) amplitude
      const double at0 = radius * amplitude - sign * (y - front.y);
      const double slope = sign * (back.y - front.y) - shrink * amplitude;
      if (slope == 0 && at0 < 0) lo = 2;
      if (slope > 0) lo = std::max(lo, -at0 / slope);
      if (slope < 0) hi = std::min(hi, -at0 / slope);
    }
    if (lo > hi) continue;
    const auto extreme = [&](double sign) { // the edge is convex (lower) or concave (upper) in the share
      double a = lo, b = hi;
      for (int k = 0; k < 45; ++k) {
        const double s1 = a + 0.381966 * (b - a), s2 = b - 0.381966 * (b - a);
        (sign * edge(s1, y, sign) > sign * edge(s2, y, sign) ? b : a) =
            sign * edge(s1, y, sign) > sign * edge(s2, y, sign) ? s2 : s1;
      }
      const double middle = edge(0.5 * (a + b), y, sign), e0 = edge(lo, y, sign), e1 = edge(hi, y, sign);
      return sign < 0 ? std::min({middle, e0, e1}) : std::max({middle, e0, e1});
    };
    const double low = extreme(-1);
    if (low >= half) continue;
    const double high = extreme(1);
    area += std::max(0.0, std::min(half, high) - std::max(-half, low)) * half * (M_PI / columns);
  }
  return area;
}

} // namespace gumshoe::tests
