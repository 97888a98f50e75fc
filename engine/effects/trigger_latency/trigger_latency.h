#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct TriggerLatency {
  static constexpr QuantityCard quantities[] = {
      {.name = "delay", .unit = "ms", .si_unit = "s", .limits = {-1e-2, 1e-1}, .symbol = "t_d",
       .meaning = "delay from the trigger to the latch", .role = Role::amplitude,
       .typical = {0.1e-3, 5e-3, "0.07 um/ms at 4 mm/min", true}},
  };
  static constexpr EffectCard card{
      .name = "trigger_latency",
      .title = "Trigger latency",
      .stage = Stage::trigger,
      .meaning = "The control latches the axes a delay after the trigger (an interrupted beam or an opened probe "
                 "switch): "
                 "latched position = position(t + delay). The effect grows with the feed.",
      .adds = "latch_delay += delay",
      .confused_with = "servo lag; a length error if all data share one feed",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.latch_delay = event.latch_delay + q[0];
  }
};

} // namespace gumshoe::effects
