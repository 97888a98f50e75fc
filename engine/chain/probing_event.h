#pragma once
/// One probing event, as the stages of the measuring chain see it: three slides alike, a touching tip, a moment; a
/// turning tool and rotary axes where there are some. Models fill in the commanded part, then effects add to the rest.
/// Without effects, or with all at their null values, simulation and evaluation are exact to the bit.
#include "math/pose.h"

namespace gumshoe::chain {

template <class T> struct TurningTool;
template <class T> struct RotaryProbing;
template <class T> struct Scanning;
template <class T> struct Contouring;
template <class T> struct BallBar;
template <class T> struct LinearAxis;

/// A slide (linear axis) at the event: actual position = commanded (1 + scale) + error, ISO 230-1.
template <class T> struct Slide {
  // commanded, known to effects
  T position = T(0.0);  ///< as the quantities predict it, never as read, m
  T direction = T(0.0); ///< from which the position was reached: +1 upwards, -1 downwards, 0 neither
  T feed = T(0.0);      ///< at which the slide moves along `direction` at the trigger, m/s, not negative
  // effects add to
  T error = T(0.0); ///< m
  T scale = T(0.0); ///< relative
};

template <class T> struct ProbingEvent {
  // commanded, known to effects
  T time = T(0.0);         ///< since the start of the work, s
  T holder_angle = T(0.0); ///< of the tool in the machine frame, rad
  T tool_length = T(0.0);  ///< nominal, m
  Slide<T> x, y, z;        ///< a spindle has z alone
  Vector3<T> approach;          ///< of a touching tip: unit vector along the machine's axes
  Vector3<T> approach_in_probe; ///< the same in the probe's frame, whose Z is along the stylus
  // pose
  T tool_x = T(0.0), tool_y = T(0.0); ///< tool axis off its nominal place, machine frame, m
  T tool_growth = T(0.0);             ///< tool longer than nominal, m
  // contact
  T pretravel = T(0.0); ///< of the tip along the approach, from contact to trigger, m
  // trigger
  T latch_delay = T(0.0); ///< s
  /// Set only for a tool that turns, and only while effects act: the stages insert, spindle and timing add to it.
  TurningTool<T>* turning = nullptr;
  /// Set only for a probe behind rotary axes, likewise: the stage rotary adds to it.
  RotaryProbing<T>* rotary = nullptr;
  /// Set only for a displacement sensor, likewise: the stages scanning, surface and sensor add to it.
  Scanning<T>* scanning = nullptr;
  /// Set only for slides that follow a contour, likewise: the stage contouring adds to it.
  Contouring<T>* contouring = nullptr;
  /// Set only for a ball bar, likewise: the stage bar adds to it.
  BallBar<T>* bar = nullptr;
  /// Set only for a linear axis against a reference, likewise: the stage axis adds to it.
  LinearAxis<T>* axis = nullptr;
};

/// What the control reads of a slide that truly stands at `actual` (m) at the trigger, and the inverse.
/// @param latch_delay from the trigger to the latch, s
template <class T> T reading_of(const T& actual, const Slide<T>& slide, const T& latch_delay) {
  return (actual - slide.error) / (1.0 + slide.scale) + slide.direction * (slide.feed * latch_delay);
}
template <class T> T actual_of(const T& reading, const Slide<T>& slide, const T& latch_delay) {
  return (reading - slide.direction * (slide.feed * latch_delay)) * (1.0 + slide.scale) + slide.error;
}

/// The same for an event that is read along Z alone.
template <class T> T reading_of(const T& actual, const ProbingEvent<T>& event) {
  return reading_of(actual, event.z, event.latch_delay);
}
template <class T> T actual_of(const T& reading, const ProbingEvent<T>& event) {
  return actual_of(reading, event.z, event.latch_delay);
}

/// What the control reads of all three slides when the tip touches with the slides truly at `actual` (m), and the
/// inverse. The tip moves on by the pretravel.
template <class T> Vector3<T> reading_of(const Vector3<T>& actual, const ProbingEvent<T>& event) {
  const Vector3<T> on = event.pretravel * event.approach;
  return {reading_of(T(actual.x + on.x), event.x, event.latch_delay),
          reading_of(T(actual.y + on.y), event.y, event.latch_delay),
          reading_of(T(actual.z + on.z), event.z, event.latch_delay)};
}
template <class T> Vector3<T> actual_of(const Vector3<T>& reading, const ProbingEvent<T>& event) {
  return Vector3<T>{actual_of(reading.x, event.x, event.latch_delay), actual_of(reading.y, event.y, event.latch_delay),
                    actual_of(reading.z, event.z, event.latch_delay)} -
         event.pretravel * event.approach;
}

} // namespace gumshoe::chain
