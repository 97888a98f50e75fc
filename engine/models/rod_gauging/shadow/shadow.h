#pragma once
/// The shadow that a measuring rod throws on the receiver of a laser tool setter, and the height at
/// which it covers a given share of the beam.
///
/// A rod (cylinder, oblique bottom plane, rolling-ball fillet) is the body shrunk by the fillet
/// radius plus a ball of that radius, so its shadow is the shrunk body's shadow dilated by a disc.
/// The shrunk body's lower edge is a sheared half-ellipse with parameter w in [-pi/2, pi/2],
///     P(w) = (rho sin w, shear rho sin w - depth cos w),
/// and the rod's lower edge is P + fillet * N with the outward unit normal N.
///
/// Source: Fang 2022, section 2.4 (eqs 2.3 to 2.32), derived anew; README.md has the mathematics.
#include "math/scalar.h"
#include "models/laser_beam.h"

namespace gumshoe::models::rod_gauging {

using laser_setter::Beam, laser_setter::Solved;

/// Lengths in m, angles in rad, in the tool-setter frame (X along the nominal beam, Z up).
template <class T> struct Rod {
  T radius;
  T fillet_radius;
  T bottom_elevation; ///< phi, of the bottom plane's normal that points into the metal; pi/2 = square end
  T bottom_azimuth;   ///< tau + theta_th
  T axis_x = T(0.0);  ///< offset of the rod's axis from the laser reference point
  T axis_y = T(0.0);
};

/// The rod's lower edge on the photodiode plane (y across, z up), relative to the beam's centre but
/// for the height `k` at which the shrunk body's axis meets its bottom.
template <class T> struct ShadowEdge {
  T rho;   ///< rod radius - fillet radius
  T depth; ///< semi-axis of the half-ellipse along z, >= 0
  T shear;
  T fillet;
  T side; ///< y of the rod's axis
};

/// The lower edge of a rod's shadow in a beam. Not finite where the bottom is parallel to the rod's axis
/// (bottom_elevation 0).
template <class T> ShadowEdge<T> shadow_edge(const Rod<T>& rod, const Beam<T>& beam) {
  const T sin_b = num::sin(beam.pitch), cos_b = num::cos(beam.pitch);
  const T cot = num::cos(rod.bottom_elevation) / num::sin(rod.bottom_elevation);
  const T g = beam.yaw - rod.bottom_azimuth;
  ShadowEdge<T> e;
  e.rho = rod.radius - rod.fillet_radius;
  e.depth = num::abs(e.rho * (sin_b + cos_b * cot * num::cos(g)));
  e.shear = cos_b * cot * num::sin(g);
  e.fillet = rod.fillet_radius;
  e.side = rod.axis_y * num::cos(beam.yaw) - rod.axis_x * num::sin(beam.yaw);
  return e;
}

/// From the edge's height k on the photodiode plane to the height of the bottom's centre, Z'_d.
template <class T> T bottom_height_of(const T& k, const Rod<T>& rod, const Beam<T>& beam) {
  const T along = rod.axis_x * num::cos(beam.yaw) + rod.axis_y * num::sin(beam.yaw);
  return (k + num::sin(beam.pitch) * along) / num::cos(beam.pitch) - rod.fillet_radius / num::sin(rod.bottom_elevation);
}

/// One point of the edge, at sin w and cos w >= 0.
template <class T> struct EdgePoint {
  T ty, tz; ///< dP/dw
  T n;      ///< its length
  T y, z;   ///< of the rod's edge, at k = 0, side included
  T growth; ///< d(rod's edge)/dw = growth * (ty, tz): the offset curve runs parallel
};
/// @param sin_w, cos_w  place on the half-ellipse, cos_w >= 0. Not finite where the half-ellipse shrinks to a point (n
/// = 0)
template <class T> EdgePoint<T> edge_point(const ShadowEdge<T>& e, const T& sin_w, const T& cos_w) {
  EdgePoint<T> p;
  p.ty = e.rho * cos_w;
  p.tz = e.shear * p.ty + e.depth * sin_w;
  p.n = num::sqrt(p.ty * p.ty + p.tz * p.tz);
  const T f = e.fillet / p.n;
  p.y = e.rho * sin_w + f * p.tz + e.side;
  p.z = e.shear * e.rho * sin_w - e.depth * cos_w - f * p.ty;
  p.growth = 1.0 + f * (e.depth * e.rho) / (p.n * p.n);
  return p;
}

/// Height of the bottom's centre above the beam's axis at the trigger, Z'_d, m. Absolute error below 1e-12 m.
///
/// The height at which the shadow covers `beam.fraction` of the beam's disc: the root of the covered area, by Newton's
/// method on the chord, or by the general solve (shadow_boundary.h) where that does not hold.
///
/// @param rod, beam  lengths in m, angles in rad; within the limits of the model's card, the fillet not larger than the
/// rod
/// @return           `never_covered` where the shadow cannot reach the fraction, `out_of_domain` where the edge is not
///                   finite
Solved<double> trigger_height(const Rod<double>& rod, const Beam<double>& beam);

} // namespace gumshoe::models::rod_gauging
