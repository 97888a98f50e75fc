#pragma once
/// Delay between the moment at which a turning tool covers the beam and the latch of the position by the control.
#include <cmath>
#include <numbers>

#include "chain/turning_tool.h"
#include "models/tool_length/trigger/lag.h"

namespace gumshoe::models::tool_length {

/// The delay by which the latched position, read as if the axis moved with its feed, is ahead of the axis at the
/// trigger, s. In this order: the revolutions of confirmation pass; the receiver, which holds the trigger, is sampled;
/// `latch_delay` passes; the axis' position is latched, actual or commanded.
///
/// Sampling is a staircase. Its derivatives are those of its mean over the phase, half a period, but the phase's own is
/// a period: a phase drawn from one cycle contributes its rectangle.
///
/// @param turned  spindle angle from the feed's begin to the trigger, rad; null if not known: long ago, and half a
///                period for the sampling
template <class T> T delay_of_latch(const chain::TurningTool<T>& tool, const T& latch_delay, const T* turned) {
  constexpr double turn = 2 * std::numbers::pi;
  const T confirmed = turn * tool.confirmations / tool.speed;
  const double period = num::value(tool.sampling_period), phase = num::value(tool.sampling_phase);
  T sampled = 0.5 * tool.sampling_period;
  if (turned && period > 0) {
    const double at = num::value(*turned) / num::value(tool.speed) + num::value(confirmed);
    const double periods = at / period - phase;
    sampled = T((std::ceil(periods) - periods) * period) + 0.5 * (tool.sampling_period - period) +
              tool.sampling_period * (tool.sampling_phase - phase);
  }
  const T delay = confirmed + sampled + latch_delay;
  if (!turned) return delay + tool.latches_command * tool.servo_lag;
  // Lag of the axis behind its command, at the trigger and at the latch.
  const T at = *turned / tool.speed;
  const T before = behind(at, tool.servo_lag), after = behind(T(at + delay), tool.servo_lag);
  const T actual = delay - (after - before);
  return actual + tool.latches_command * after;
}

} // namespace gumshoe::models::tool_length
