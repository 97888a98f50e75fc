#pragma once
/// Gauging the height of a laser tool setter's beam with a measuring rod.
///
/// The spindle lowers the rod until its shadow covers a share of the beam's disc; the control latches
/// the spindle height Z'_s. With the rod's length L_r and the height Z'_d of its bottom's centre above
/// the beam's axis at that moment, the axis lies at laser_z = Z'_s - L_r - Z'_d.
/// Source: Fang 2022, chapter 2 (eq 2.38), solved anew: shadow/shadow.h.
#include "models/rod_gauging/shadow/trigger_height.h"
#include "effects/act.h"
#include "models/laser_setter.h"

namespace gumshoe::models::rod_gauging {

enum Quantity {
  radius,
  fillet,
  elevation,
  azimuth,
  length,
  holder_angle,
  yaw,
  pitch,
  beam_radius,
  fraction,
  laser_z,
  count
};
enum Condition { feed, time, direction, conditions };
enum Measurand { bottom_height_row, laser_z_row, measurands };
enum Evaluation { full, conventional };

/// The event as commanded, with all active effects applied.
template <class T>
chain::ProbingEvent<T> probing_event(const T* q, const T* condition, const T* effect_quantities,
                                     std::span<const effects::Active> active) {
  chain::ProbingEvent<T> event;
  event.z.feed = condition[feed];
  event.time = condition[time];
  event.z.direction = condition[direction];
  event.holder_angle = q[holder_angle];
  event.tool_length = q[length];
  effects::act(active, effect_quantities, event);
  return event;
}

template <class T> Rod<T> rod(const T* q, const chain::ProbingEvent<T>& event) {
  return {q[radius], q[fillet], q[elevation], q[azimuth] + q[holder_angle], event.tool_x, event.tool_y};
}
template <class T> Beam<T> beam(const T* q) { return laser_setter::beam(q + yaw); }

/// The machine: what the control reads when the beam's axis lies at q[laser_z].
template <class T> T simulate(const T* q, const T& bottom_height, const chain::ProbingEvent<T>& event) {
  const T actual = q[laser_z] + q[length] + event.tool_growth + bottom_height;
  return chain::reading_of(actual, event);
}

/// The measurement model: the beam's axis from the reading; the inverse of simulate.
template <class T>
T evaluate(const T& spindle_z, const T* q, const T& bottom_height, const chain::ProbingEvent<T>& event) {
  return chain::actual_of(spindle_z, event) - (q[length] + event.tool_growth) - bottom_height;
}

} // namespace gumshoe::models::rod
