#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct SpindleSpeedError {
  static constexpr QuantityCard quantities[] = {
      {.name = "error", .unit = "%", .si_unit = "1", .limits = {-0.5, 0.5},
       .meaning = "true speed minus commanded speed, relative", .role = Role::amplitude, .typical = {1e-4, 1e-2}},
  };
  static constexpr EffectCard card{
      .name = "spindle_speed_error",
      .title = "Speed error of the spindle",
      .stage = Stage::spindle,
      .meaning = "True speed = commanded speed (1 + error). The tool descends feed / true speed per revolution, which "
                 "scales the grid of heights, and it reaches the beam at another angle.",
      .adds = "speed *= 1 + error",
      .confused_with = "spindle_speed, exactly; the start of the feed (the phase error grows with the start height)",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.turning->speed = event.turning->speed * (1.0 + q[0]);
  }
};

} // namespace gumshoe::effects
