#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct FeedStartDelay {
  static constexpr QuantityCard quantities[] = {
      {.name = "delay", .unit = "ms", .si_unit = "s", .limits = {-10.0, 10.0},
       .meaning = "delay from the start angle to the start of the feed", .role = Role::amplitude,
       .typical = {1e-3, 20e-3, "6 deg per ms at 1000 rpm", true}},
  };
  static constexpr EffectCard card{
      .name = "feed_start_delay",
      .title = "Delay of the feed",
      .stage = Stage::timing,
      .meaning = "The feed begins this long after the spindle passes the start angle, so the tool has turned on by "
                 "speed times delay: the characteristic curve moves to smaller start angles by 6 deg per rpm and "
                 "second.",
      .adds = "turns_before_feed += speed delay",
      .confused_with = "holder_angle at one speed; the start height (1 um is 12 deg at 1000 rpm and 30 mm/min)",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.turns_before_feed = tool.turns_before_feed + tool.speed * q[0];
  }
};

} // namespace gumshoe::effects
