#pragma once
/// A ball bar between a fixed and a moving ball, as the stage bar of the measuring chain sees it: what is indicated of
/// the distance between the balls' centres, and the inverse. The time of the reading is the event's.
#include "chain/probing_event.h"

namespace gumshoe::chain {

template <class T> struct BallBar {
  // commanded, known to effects
  T length = T(0.0); ///< nominal distance between the balls' centres, m
  Vector3<T> along;  ///< unit vector from the fixed ball to the moving one, machine axes
  T speed = T(0.0);  ///< rate of change of the length while it is read, m/s; 0 at rest
  // effects add to
  T zero = T(0.0);   ///< excess of the indication, m
  T growth = T(0.0); ///< of the bar itself, which indicates less the longer it is, m
  T skew = T(0.0);   ///< from the commanded moment to the reading, s
};

/// Indication minus true length, m.
template <class T> T indication_error(const BallBar<T>& bar) { return bar.zero - bar.growth + bar.speed * bar.skew; }

/// What the bar indicates when the balls' centres are `actual` apart (m), and the inverse. A change of the length from
/// its nominal value is read in the same way.
template <class T> T reading_of(const T& actual, const BallBar<T>& bar) { return actual + indication_error(bar); }
template <class T> T actual_of(const T& reading, const BallBar<T>& bar) { return reading - indication_error(bar); }

} // namespace gumshoe::chain
