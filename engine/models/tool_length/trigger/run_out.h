#pragma once
/// The true seat of a flute: with its own deviations, in a tool with run-out.
#include <type_traits>

#include "models/tool_length/trigger/insert_trigger.h"

namespace gumshoe::models::tool_length {

/// Flute k of a tool that runs out. An insert is a body of revolution, so wherever its axis points it is an insert with
/// other angles in a displaced seat: exact for any run-out, and exactly what it was at zero.
template <class T> Flute<T> run_out(const Flute<T>& f, const chain::TurningTool<T>& tool) {
  struct Vector {
    T x, y, z;
  };
  if constexpr (std::is_same_v<T, double>)
    if (tool.runout_x == 0 && tool.runout_y == 0 && tool.tilt_x == 0 && tool.tilt_y == 0) return f;
  const Insert<T>& i = f.insert;
  const T c = num::cos(f.azimuth), s = num::sin(f.azimuth);
  const auto loss = [](const T& t) { // cos - 1
    const T half = num::sin(0.5 * t);
    return -(2.0 * half * half);
  };
  const T sx = num::sin(tool.tilt_x), lx = loss(tool.tilt_x);
  const T sy = num::sin(tool.tilt_y), ly = loss(tool.tilt_y);
  // How a vector of the seat's frame changes when the tool tilts.
  const auto change = [&](const Vector& v) {
    const Vector t{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
    const T dy = t.y * lx - t.z * sx, dz = t.y * sx + t.z * lx, z = t.z + dz;
    const T ex = t.x * ly + z * sy, ez = dz + (z * ly - t.x * sy);
    return Vector{c * ex + s * dy, c * dy - s * ex, ez};
  };
  const auto rake = [&](const T& radial, const T& axial) { // of the rake circle's centre from the cutting point
    const T sr = num::sin(radial), cr = num::cos(radial), sa = num::sin(axial), ca = num::cos(axial);
    return Vector{i.radius * (sr * sa - cr), i.radius * (cr * sa + sr), i.radius * ca};
  };
  const T sr = num::sin(i.radial_angle), cr = num::cos(i.radial_angle);
  const T sa = num::sin(i.axial_angle), ca = num::cos(i.axial_angle);
  const Vector dn = change({sr * ca, cr * ca, -sa}); // the insert's axis
  const T along = ca + (dn.x * sr + dn.y * cr), across = dn.x * cr - dn.y * sr;
  const T sine = sa - dn.z, cosine = num::sqrt(along * along + across * across);
  const T radial = i.radial_angle + num::atan2(across, along);
  const T axial = i.axial_angle + num::atan2(sine * ca - cosine * sa, cosine * ca + sine * sa);
  const Vector was = rake(i.radial_angle, i.axial_angle), is = rake(radial, axial);
  const Vector centre = change({i.tool_radius + was.x, i.seat + was.y, f.raise + was.z});
  Flute<T> r = f;
  r.insert.radial_angle = radial;
  r.insert.axial_angle = axial;
  r.insert.tool_radius = i.tool_radius + ((c * tool.runout_x + s * tool.runout_y) + (centre.x - (is.x - was.x)));
  r.insert.seat = i.seat + ((c * tool.runout_y - s * tool.runout_x) + (centre.y - (is.y - was.y)));
  r.raise = f.raise + (centre.z - (is.z - was.z));
  return r;
}

/// Flute k, from 0, with its own deviations, in a tool that runs out.
template <class T> Flute<T> deviating(Flute<T> f, const chain::TurningTool<T>& tool, int k) {
  const chain::InsertDeviation<T>& d = tool.insert[static_cast<std::size_t>(k)];
  f.insert.radius = f.insert.radius + d.radius;
  f.insert.tool_radius = f.insert.tool_radius + d.tool_radius;
  f.insert.radial_angle = f.insert.radial_angle + d.radial_angle;
  f.insert.axial_angle = f.insert.axial_angle + d.axial_angle;
  f.azimuth = f.azimuth + d.azimuth;
  return run_out(f, tool);
}

} // namespace gumshoe::models::tool_length
