#pragma once
/// The shadow of one round insert of a mill: the convex hull of two projected circles, the cutting edge on the rake
/// face and the far end of the conical flank.
///
/// t_from_i = Trans(r, seat, 0) Rz(-theta_r) Rx(-theta_a); rake circle about (-R, 0, R) in the insert's X-Z plane,
/// flank towards +Y with radius R - y tan(tau). Lengths m, angles rad, frames as in engine/models/README.md. Source: Fang 2022,
/// section 3.3 (eqs 3.1 to 3.9), derived anew.
#include <numbers>

#include "math/scalar.h"
#include "models/laser_beam.h"
#include "models/named.h"

namespace gumshoe::models::tool_length {

using laser_setter::Beam, laser_setter::Solved, std::numbers::pi;

template <class T> struct Insert {
  T tool_radius; ///< r, from the tool's axis to the virtual cutting point
  T radius;      ///< R, of the cutting edge
  T thickness;
  T clearance; ///< tau
  T radial_angle, axial_angle;
  T axis_x = T(0.0), axis_y = T(0.0); ///< offset of the tool's axis from the laser reference point
  T seat = T(0.0);                    ///< tangential displacement of the seat, towards the insert's Y at no tilt
  bool operator==(const Insert&) const = default;
};

template <class T> struct Planar { T y, z; };
template <class T> T cross(const Planar<T>& a, const Planar<T>& b) { return a.y * b.z - a.z * b.y; }
template <class T> T dot(const Planar<T>& a, const Planar<T>& b) { return a.y * b.y + a.z * b.z; }

/// Points centre + radius (a cos w + b sin w) of two ellipses of one shape; the tool's centre at height 0.
template <class T> struct InsertShadow {
  Planar<T> rake, back; ///< centres
  Planar<T> a, b;       ///< a x b >= 0
  T rake_radius, back_radius;
};

/// An insert in the tool's frame, ready to be turned.
template <class T> struct InsertBody {
  struct Vector {
    T x, y, z;
  };
  Vector rake, back, a, b;
  T rake_radius, back_radius;
  T side, rise; ///< of the tool's axis on the photodiode plane
  T yaw, sin_pitch, cos_pitch;
};

/// The insert's two circles in the tool's frame and what its shadow in this beam needs. The clearance must be below 90
/// deg.
template <class T> InsertBody<T> insert_body(const Insert<T>& i, const Beam<T>& beam) {
  const T sr = num::sin(i.radial_angle), cr = num::cos(i.radial_angle);
  const T sa = num::sin(i.axial_angle), ca = num::cos(i.axial_angle);
  InsertBody<T> body;
  body.a = {cr, -sr, T(0.0)};
  body.b = {sr * sa, cr * sa, ca};
  const T yx = sr * ca, yy = cr * ca, yz = -sa; // the insert's Y
  body.rake = {i.tool_radius + i.radius * (body.b.x - body.a.x), i.seat + i.radius * (body.b.y - body.a.y),
               i.radius * body.b.z};
  body.back = {body.rake.x + i.thickness * yx, body.rake.y + i.thickness * yy, body.rake.z + i.thickness * yz};
  body.rake_radius = i.radius;
  body.back_radius = i.radius - i.thickness * (num::sin(i.clearance) / num::cos(i.clearance));
  body.yaw = beam.yaw;
  body.sin_pitch = num::sin(beam.pitch);
  body.cos_pitch = num::cos(beam.pitch);
  const T s = num::sin(beam.yaw), c = num::cos(beam.yaw);
  body.side = i.axis_y * c - i.axis_x * s;
  body.rise = -(body.sin_pitch * (i.axis_x * c + i.axis_y * s));
  return body;
}

/// The shadow of the insert turned by `angle` (rad), counter-clockwise seen from above, with the tool's centre at
/// height 0.
template <class T> InsertShadow<T> insert_shadow(const InsertBody<T>& body, const T& angle) {
  const T c = num::cos(angle - body.yaw), s = num::sin(angle - body.yaw);
  const auto project = [&](const auto& v) {
    return Planar<T>{s * v.x + c * v.y, body.cos_pitch * v.z - body.sin_pitch * (c * v.x - s * v.y)};
  };
  InsertShadow<T> shadow{project(body.rake), project(body.back), project(body.a),
                         project(body.b),    body.rake_radius,   body.back_radius};
  for (Planar<T>* centre : {&shadow.rake, &shadow.back}) {
    centre->y = centre->y + body.side;
    centre->z = centre->z + body.rise;
  }
  if (num::value(cross(shadow.a, shadow.b)) < 0) shadow.b = {-shadow.b.y, -shadow.b.z};
  return shadow;
}

} // namespace gumshoe::models::tool_length
