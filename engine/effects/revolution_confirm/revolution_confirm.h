#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A trigger is accepted only after further revolutions with an interruption each.
struct RevolutionConfirm {
  static constexpr QuantityCard quantities[] = {
      {"revolutions", "1", "1", 0.0, {0.0, 1000.0}, "n", "further revolutions; whole in a receiver, any number in a fit", Role::amplitude, "0-2"},
  };
  static constexpr EffectCard card{
      "revolution_confirm",
      "Confirmation of the trigger",
      "timing",
      30,
      "",
      "The receiver takes a trigger for a drop of coolant until the beam was interrupted in each of n further "
      "revolutions, and then accepts the first moment, n revolutions or more after the trigger, at which the beam is "
      "covered. The flute that triggered stands lower then and covers the beam at the same spindle angle: n "
      "revolutions later exactly, n times the descent per revolution lower.",
      "trigger_latency at one speed; a length error while all readouts share feed and speed",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.confirmations = tool.confirmations + q[0];
  }
};

} // namespace gumshoe::effects
