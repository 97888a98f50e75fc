#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The feed begins a delay after the spindle passes the start angle.
struct FeedStartDelay {
  static constexpr QuantityCard quantities[] = {
      {"delay",
       "ms",
       "s",
       0.0,
       {-10.0, 10.0},
       "",
       "from the start angle to the feed's begin",
       Role::amplitude,
       "1-20 ms: 6 deg per ms at 1000 rpm"},
  };
  static constexpr EffectCard card{
      "feed_start_delay",
      "Delay of the feed",
      "timing",
      10,
      "",
      "The feed begins this long after the spindle passes the start angle, so the tool has turned on by speed times "
      "delay: the characteristic curve moves to smaller start angles by 6 deg per rpm and second.",
      "holder_angle at one speed; the start height (1 um is 12 deg at 1000 rpm and 30 mm/min)",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.turns_before_feed = tool.turns_before_feed + tool.speed * q[0];
  }
};

} // namespace gumshoe::effects
