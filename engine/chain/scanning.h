#pragma once
/// A displacement sensor that scans a surface: what the stages scanning, surface and sensor see and add to.
#include "chain/probing_event.h"

namespace gumshoe::chain {

template <class T> struct Scanning {
  // commanded, known to effects
  T azimuth = T(0.0);      ///< of the spot about the workpiece's centre, from the table's X, rad
  T part_angle = T(0.0);   ///< by which the part is turned on its seat; the part's own azimuth is azimuth - part_angle, rad
  T turn_rate = T(0.0);    ///< of the scanning axis, signed, rad/s
  T displacement = T(0.0); ///< as the quantities predict it, without effects, m
  // effects add to
  T skew = T(0.0);  ///< from the moment at which the axes are read to that at which the sensor is, s
  T form = T(0.0);  ///< by how much the surface is nearer to the sensor, along the beam, m
  T error = T(0.0); ///< of the sensor's indication, m
};

} // namespace gumshoe::chain
