#pragma once
/// The beam of a laser tool setter, and what a solve for the height of a trigger in it returns.
///
/// Frame of the tool setter: X along the nominal beam, Z up, right-handed; the origin is the laser reference point, on
/// the beam's axis. engine/models/README.md has the conventions.
#include "base/status.h"

namespace gumshoe::models::laser_setter {

template <class T> struct Beam {
  T yaw;      ///< alpha, of the beam about Z, rad
  T pitch;    ///< beta, of the beam out of the horizontal, positive upwards along the beam, rad
  T radius;   ///< R_l, of the beam's disc on the receiver, m
  T fraction; ///< share of the disc that is covered at the trigger, in (0, 1)
  bool operator==(const Beam&) const = default;
};

template <class T> struct Solved {
  T value;
  Status status = Status::ok;
  bool kink = false; ///< the value has no derivative here (an aligned square rod at pitch 0)
};

} // namespace gumshoe::models::laser_setter
