#pragma once
/// One probing event along Z, as the stages of the measuring chain see it. Models fill in the
/// commanded part; effects add to the rest, each at its own stage, in rank order. With no effect,
/// or all at their null values, simulation and evaluation are exact to the bit.
#include "math/scalar.h"

namespace gumshoe::chain {

template <class T> struct TurningTool;
template <class T> struct RotaryProbing;

template <class T> struct ProbingEvent {
  // commanded, known to effects
  T feed = T(0.0);         ///< m/s, positive
  T time = T(0.0);         ///< s since the start of the work
  T direction = T(-1.0);   ///< of approach along Z
  T holder_angle = T(0.0); ///< of the tool in the machine frame, rad
  T tool_length = T(0.0);  ///< nominal, m
  // pose
  T tool_x = T(0.0), tool_y = T(0.0); ///< tool axis beside its nominal place, machine frame, m
  T tool_growth = T(0.0);             ///< tool longer than nominal, m
  // motion: actual = commanded (1 + axis_scale) + axis_error
  T axis_error = T(0.0);
  T axis_scale = T(0.0);
  // trigger
  T latch_delay = T(0.0); ///< s
  /// Only of a tool that turns, and only while effects act: what the stages spindle, timing and insert add to.
  TurningTool<T>* turning = nullptr;
  /// Only of a probe behind rotary axes, likewise: what rotary, slides and contact add to.
  RotaryProbing<T>* rotary = nullptr;
};

/// What the control reads when the axis truly stands at `actual` at the trigger, and the inverse.
template <class T> T reading_of(const T& actual, const ProbingEvent<T>& event) {
  return (actual - event.axis_error) / (1.0 + event.axis_scale) + event.direction * (event.feed * event.latch_delay);
}
template <class T> T actual_of(const T& reading, const ProbingEvent<T>& event) {
  return (reading - event.direction * (event.feed * event.latch_delay)) * (1.0 + event.axis_scale) + event.axis_error;
}

} // namespace gumshoe::chain
