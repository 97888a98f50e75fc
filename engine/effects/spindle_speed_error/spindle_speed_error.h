#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Speed of the spindle. True speed = commanded speed (1 + error).
struct SpindleSpeedError {
  static constexpr QuantityCard quantities[] = {
      {"error",
       "%",
       "1",
       0.0,
       {-0.5, 0.5},
       "",
       "true speed minus commanded speed, relative",
       Role::amplitude,
       "0.01-1 %"},
  };
  static constexpr EffectCard card{
      "spindle_speed_error",
      "Speed of the spindle",
      "spindle",
      10,
      "",
      "True speed = commanded speed (1 + error). The tool descends feed / true speed per revolution, which scales the "
      "grid of heights, and has turned otherwise when it reaches the beam.",
      "spindle_speed, exactly; the start of the feed (the phase runs away with the start height)",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.turning->speed = event.turning->speed * (1.0 + q[0]);
  }
};

} // namespace gumshoe::effects
