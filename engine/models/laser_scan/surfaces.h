#pragma once
/// Surfaces of the part and where a beam meets them, in the frame of the part: origin on its axis, at the table's height.
///
/// All solve for t, where beam.from + t beam.along lies on the surface, the root of smallest |t|. README.md derives them.
#include "math/pose.h"
#include "models/reading.h"

namespace gumshoe::models::laser_scan {

/// Values of the condition `surface`.
enum Surface { cone, plane, cylinder, sphere, torus, surfaces };

template <class T> struct Shape {
  T cone_slope, cone_radius, cone_height;
  T height; ///< of the plane at the part's axis, of the cylinder's axis, of the sphere's and the torus' centre
  T slope_x, slope_y;
  T azimuth;    ///< of the cylinder's axis
  T radius;     ///< of cylinder, sphere or tube; negative: hollow
  T ring_radius;
};

template <class T> struct Beam { Vector3<T> from, along; };
template <class T> using Mask = decltype(T() < T());

/// A root, and whether there is one. Of a cone, whether there are only such as lie on its other nappe.
template <class T> struct Meeting {
  T t;
  Mask<T> there, behind_tip = T(0.0) != T(0.0);
};

template <class T> T square(const T& x) { return x * x; }
template <class T> T across_cylinder(const Shape<T>& s, const Vector3<T>& p) {
  return p.y * num::cos(s.azimuth) - p.x * num::sin(s.azimuth);
}
/// The height of a circle's upper half (lower, if hollow) at a distance from its centre; NaN beyond it.
template <class T> T arc(const T& radius, const T& distance) {
  const T share = distance / radius;
  return radius * num::sqrt((1.0 - share) * (1.0 + share));
}

/// Nominal height of the surface over (x, y); NaN where there is none.
template <class T> T height_over(int surface, const Shape<T>& s, const Vector3<T>& p, const T& distance) {
  switch (surface) {
  case cone:
    return s.cone_height + s.cone_slope * (distance - s.cone_radius);
  case plane:
    return s.height + s.slope_x * p.x + s.slope_y * p.y;
  case cylinder:
    return s.height + arc(s.radius, across_cylinder(s, p));
  case sphere:
    return s.height + arc(s.radius, distance);
  default:
    return s.height + arc(s.radius, T(distance - s.ring_radius));
  }
}

/// a t^2 + 2 b t + c = 0, without cancellation: of both roots the smaller.
template <class T> Meeting<T> smaller_root(const T& a, const T& b, const T& c) {
  const T square_of_root = b * b - a * c;
  const auto there = square_of_root >= T(0.0);
  const T root = num::sqrt(num::select(there, square_of_root, T(1.0)));
  return {-(c / (b + num::select(b < T(0.0), -root, root))), there};
}

/// z = height + slope (rho - radius), solved for the change of rho along the beam, in which the equation is a quadratic
/// for any slope, zero included. Where that change carries rho below 0 the beam meets the other nappe.
template <class T> Meeting<T> meet_cone(const Shape<T>& s, const Beam<T>& beam) {
  const auto& [p, u] = beam;
  const T& m = s.cone_slope;
  const T rho = num::sqrt(p.x * p.x + p.y * p.y), gap = p.z - s.cone_height - m * (rho - s.cone_radius);
  const T outwards = p.x * u.x + p.y * u.y, level = u.x * u.x + u.y * u.y;
  const T a = u.z * u.z - m * m * level, b = u.z * (rho * u.z - m * outwards) + level * m * gap;
  const T c = gap * (2.0 * outwards * u.z - level * gap);
  const auto near = smaller_root(a, b, c);
  const T zero(0.0), one(1.0);
  const T far = -2.0 * b / num::select(a == zero, one, a) - near.t;
  const T t_near = (m * near.t - gap) / u.z, t_far = (m * far - gap) / u.z;
  const auto steep = near.there && (num::abs(u.z) > T(1e-9));
  const auto near_there = steep && (rho + near.t >= zero), far_there = steep && (a != zero) && (rho + far >= zero);
  const auto take_far = far_there && (!near_there || (num::abs(t_far) < num::abs(t_near)));
  const auto there = near_there || far_there;
  return {num::select(take_far, t_far, t_near), there, steep && !there};
}

template <class T> Meeting<T> meet_plane(const Shape<T>& s, const Beam<T>& beam) {
  const auto& [p, u] = beam;
  const T towards = u.z - s.slope_x * u.x - s.slope_y * u.y;
  const T gap = p.z - s.height - s.slope_x * p.x - s.slope_y * p.y;
  return {-(gap / towards), num::abs(towards) > T(1e-6)};
}

template <class T> Meeting<T> meet_cylinder(const Shape<T>& s, const Beam<T>& beam) {
  const T p = across_cylinder(s, beam.from), u = across_cylinder(s, beam.along), h = beam.from.z - s.height;
  const T a = u * u + square(beam.along.z);
  auto root = smaller_root(a, T(p * u + h * beam.along.z), T(p * p + (h - s.radius) * (h + s.radius)));
  root.there = root.there && (a > T(1e-12));
  return root;
}

template <class T> Meeting<T> meet_sphere(const Shape<T>& s, const Beam<T>& beam) {
  const auto& [p, u] = beam;
  const T h = p.z - s.height;
  return smaller_root(T(1.0), T(p.x * u.x + p.y * u.y + h * u.z),
                      T(p.x * p.x + p.y * p.y + (h - s.radius) * (h + s.radius)));
}

/// By Newton's method on the distance from the tube; each level of derivatives takes a further step.
template <class T> Meeting<T> meet_torus(const Shape<T>& s, const Beam<T>& beam, Mask<T>& converged) {
  const T tube = num::abs(s.radius), one(1.0);
  T t(0.0);
  converged = one != one;
  int further = num::derivative_levels<T>;
  for (int i = 0; i < 50 && further >= 0; ++i) {
    const Vector3<T> p = beam.from + t * beam.along;
    const T rho = num::sqrt(p.x * p.x + p.y * p.y), off = rho - s.ring_radius, h = p.z - s.height;
    const T from_ring = num::sqrt(off * off + h * h);
    const T outwards = (p.x * beam.along.x + p.y * beam.along.y) / rho;
    const T step = (from_ring - tube) * from_ring / (off * outwards + h * beam.along.z);
    const auto done = further == num::derivative_levels<T> ? converged : one != one;
    t = num::select(done, t, T(t - step));
    converged = converged || (num::abs(step) < T(1e-14) * (1.0 + num::abs(t)));
    if (!num::any(!converged)) --further;
  }
  return {t, t == t};
}

} // namespace gumshoe::models::laser_scan
