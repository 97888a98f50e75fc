#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The feed axis follows its command with a first-order lag, from rest.
struct ServoLag {
  static constexpr QuantityCard quantities[] = {
      {"time_constant",
       "ms",
       "s",
       0.0,
       {0.0, 10.0},
       "1/K_v",
       "following error over feed",
       Role::amplitude,
       "1-60 ms: 0.5 um per ms at 30 mm/min"},
      {"latches_command",
       "1",
       "1",
       0.0,
       {0.0, 1.0},
       "",
       "1: the control latches the commanded position; 0: the actual one, from the scale",
       Role::shape,
       "0 or 1"},
  };
  static constexpr EffectCard card{
      "servo_lag",
      "Lag of the feed axis",
      "timing",
      20,
      "",
      "The axis follows its command with a first-order lag, from rest: it stands higher by feed (time_constant) (1 - "
      "exp(-t / time_constant)), so the tool reaches the beam later and in another phase. A control that latches the "
      "scale reads the true position all the same; one that latches its own command reads lower by the following "
      "error.",
      "feed_start_delay, exactly, once the feed is steady and the scale is latched; trigger_latency if the command is "
      "latched",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.servo_lag = tool.servo_lag + q[0];
    tool.latches_command = tool.latches_command + q[1];
  }
};

} // namespace gumshoe::effects
