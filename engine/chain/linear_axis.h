#pragma once
/// One linear axis whose position a reference measures, as the stage axis of the measuring chain sees it. The time of
/// the reading is the event's.
#include "chain/probing_event.h"

namespace gumshoe::chain {

inline constexpr double reference_temperature = 293.15; ///< to which lengths refer, ISO 1, K

template <class T> struct LinearAxis {
  // commanded or recorded, known to effects; its position and direction are those of the slide
  T travel = T(0.0);                        ///< from the datum to the position, m
  T pitch = T(0.0);                         ///< of its screw or scale, m; 0: not known
  T temperature = T(reference_temperature); ///< of the axis' scale, K
  T pitch_angle = T(0.0);                   ///< angular error of the axis at the position, rad
  // effects add to its error
  Slide<T> slide;
};

} // namespace gumshoe::chain
