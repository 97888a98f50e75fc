#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// The receiver is looked at once in a period; it holds the trigger until then.
struct SamplingRate {
  static constexpr QuantityCard quantities[] = {
      {"period", "ms", "s", 0.0, {0.0, 1.0}, "T", "of sampling", Role::amplitude, "0.1-4 ms"},
      {"phase",
       "1",
       "1",
       0.0,
       {0.0, 1.0},
       "",
       "share of a period from the feed's begin to the first sampling",
       Role::shape,
       "0 to 1: rectangular where the clocks are free"},
  };
  static constexpr EffectCard card{
      "sampling_rate",
      "Sampling of the receiver",
      "timing",
      40,
      "",
      "The receiver holds the trigger, none is missed, until it is next looked at: a latency between nothing and a "
      "period. A phase drawn from 0 to 1 makes it rectangular. The reading is a staircase and has no derivative; the "
      "engine gives those of its mean (half a period) and, for the phase, one period, which for a phase from 0 to 1 is "
      "the rectangle's uncertainty.",
      "trigger_latency, of half a period",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.sampling_period = tool.sampling_period + q[0];
    tool.sampling_phase = tool.sampling_phase + q[1];
  }
};

} // namespace gumshoe::effects
