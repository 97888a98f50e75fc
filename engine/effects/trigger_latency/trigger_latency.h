#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Trigger latency. The control latches the axes a delay after the trigger, a beam broken or a probe's switch opened:
/// latched position = position(t + delay). Grows with feed.
struct TriggerLatency {
  static constexpr QuantityCard quantities[] = {
      {"delay",
       "ms",
       "s",
       0.0,
       {-1e-2, 1e-1},
       "t_d",
       "from the trigger to the latch",
       Role::amplitude,
       "0.1-5 ms: 0.07 um/ms at 4 mm/min"},
  };
  static constexpr EffectCard card{"trigger_latency",
                                   "Trigger latency",
                                   "trigger",
                                   10,
                                   "",
                                   "The control latches the axes a delay after the trigger, a beam broken or a probe's "
                                   "switch opened: latched position = "
                                   "position(t + delay). Grows with feed.",
                                   "servo lag; a length error when all data share one feed",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.latch_delay = event.latch_delay + q[0];
  }
};

} // namespace gumshoe::effects
