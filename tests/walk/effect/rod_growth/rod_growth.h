#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct RodGrowth {
  static constexpr QuantityCard quantities[] = {
      {.name = "rate", .unit = "um/h", .si_unit = "m/s", .limits = {-1e-6, 1e-6}, .symbol = "r",
       .meaning = "growth of the rod or tool per time", .role = Role::amplitude,
       .typical = {0.5e-6 / 3600, 10e-6 / 3600}},
  };
  static constexpr EffectCard card{
      .name = "rod_growth",
      .title = "Growth of the rod or tool with time",
      .stage = Stage::pose,
      .meaning = "The rod or tool warms while it is used: it grows in proportion to the time since the start of the work.",
      .adds = "tool_growth += rate time",
      .confused_with = "thermal_growth (the spindle's nose moves likewise)",
      .source = "an example",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_growth = event.tool_growth + q[0] * event.time;
  }
};

} // namespace gumshoe::effects
