#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct RevolutionConfirm {
  static constexpr QuantityCard quantities[] = {
      {.name = "revolutions", .unit = "1", .si_unit = "1", .limits = {0.0, 1000.0}, .symbol = "n",
       .meaning = "further revolutions; an integer in a receiver, any value in a fit", .role = Role::amplitude,
       .typical = {0, 2}},
  };
  static constexpr EffectCard card{
      .name = "revolution_confirm",
      .title = "Confirmation of the trigger",
      .stage = Stage::timing,
      .meaning = "The receiver treats a trigger as a drop of coolant until the beam has been interrupted in each of n "
                 "further revolutions. It then accepts the first moment, n revolutions or more after the trigger, at "
                 "which the beam is covered. By then the flute that triggered is lower and covers the beam at the "
                 "same spindle angle, exactly n revolutions later and n times the descent per revolution lower.",
      .adds = "confirmations += revolutions",
      .confused_with = "trigger_latency at one speed; a length error if all indications share feed and speed",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.confirmations = tool.confirmations + q[0];
  }
};

} // namespace gumshoe::effects
