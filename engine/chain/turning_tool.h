#pragma once
/// What effects may do to a tool that turns: to its spindle, to the moments at which things happen, to how it sits and
/// to each insert. All fields are deviations with 0 for none, but for those that are commanded.
#include <array>
#include <type_traits>

#include "chain/insert_trigger.h"
#include "chain/probing_event.h"

/// One row per insert: GUMSHOE_FOR_EACH_INSERT(ROW) is ROW(1), ROW(2) ... ROW(12).
#define GUMSHOE_FOR_EACH_INSERT(ROW)                                                                                   \
  ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10), ROW(11), ROW(12)

namespace gumshoe::chain {

template <class T> struct InsertDeviation {
  T radius = T(0.0);                             ///< of the cutting edge; the virtual cutting point stays, m
  T tool_radius = T(0.0);                        ///< m
  T azimuth = T(0.0);                            ///< of the seat, rad
  T radial_angle = T(0.0), axial_angle = T(0.0); ///< rad
};

template <class T> struct TurningTool {
  // spindle
  T speed = T(0.0); ///< rad/s: commanded, then true
  // timing
  T turns_before_feed = T(0.0);                        ///< rad turned between the start angle and the feed's begin
  T servo_lag = T(0.0);                                ///< time constant of the feed axis, s
  T latches_command = T(0.0);                          ///< 1: the control latches commanded positions, 0: actual ones
  T sampling_period = T(0.0), sampling_phase = T(0.0); ///< s; share of a period from the feed's begin
  T confirmations = T(0.0);                            ///< further revolutions until a trigger is accepted
  // insert
  T runout_x = T(0.0), runout_y = T(0.0); ///< of the tool's axis at the tool's centre, X through the first seat, m
  T tilt_x = T(0.0), tilt_y = T(0.0);     ///< of the tool about its centre: first about X, then about Y, rad
  std::array<InsertDeviation<T>, most_inserts> insert{};
};

/// Flute k of a tool that runs out. An insert is a body of revolution, so wherever its axis points it is an insert with
/// other angles in a displaced seat: exact for any run-out, and exactly what it was at zero.
template <class T> Flute<T> run_out(const Flute<T>& f, const TurningTool<T>& tool) {
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
template <class T> Flute<T> deviating(Flute<T> f, const TurningTool<T>& tool, int k) {
  const InsertDeviation<T>& d = tool.insert[static_cast<std::size_t>(k)];
  f.insert.radius = f.insert.radius + d.radius;
  f.insert.tool_radius = f.insert.tool_radius + d.tool_radius;
  f.insert.radial_angle = f.insert.radial_angle + d.radial_angle;
  f.insert.axial_angle = f.insert.axial_angle + d.axial_angle;
  f.azimuth = f.azimuth + d.azimuth;
  return run_out(f, tool);
}

} // namespace gumshoe::chain
