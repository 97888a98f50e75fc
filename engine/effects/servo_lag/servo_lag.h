#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct ServoLag {
  static constexpr QuantityCard quantities[] = {
      {.name = "time_constant", .unit = "ms", .si_unit = "s", .limits = {0.0, 10.0}, .symbol = "1/K_v",
       .meaning = "following error divided by feed", .role = Role::amplitude,
       .typical = {1e-3, 60e-3, "0.5 um per ms at 30 mm/min"}},
      {.name = "latches_command", .unit = "1", .si_unit = "1", .limits = {0.0, 1.0},
       .meaning = "1: the control latches the commanded position; 0: the actual one, from the scale",
       .role = Role::shape, .typical = {0, 1}},
  };
  static constexpr EffectCard card{
      .name = "servo_lag",
      .title = "Lag of the feed axis",
      .stage = Stage::timing,
      .meaning = "The axis follows its command with a first-order lag, from rest: it is higher by feed "
                 "(time_constant) (1 - exp(-t / time_constant)), so that the tool reaches the beam later and at "
                 "another "
                 "phase. A control that latches the scale still reads the true position; one that latches its own "
                 "command reads lower by the following error.",
      .adds = "servo_lag += time_constant; latches_command += latches_command",
      .confused_with = "feed_start_delay, exactly, once the feed is steady and the scale is latched; trigger_latency "
                       "if the command is latched",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.servo_lag = tool.servo_lag + q[0];
    tool.latches_command = tool.latches_command + q[1];
  }
};

} // namespace gumshoe::effects
