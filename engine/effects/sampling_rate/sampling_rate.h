#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct SamplingRate {
  static constexpr QuantityCard quantities[] = {
      {.name = "period", .unit = "ms", .si_unit = "s", .limits = {0.0, 1.0}, .symbol = "T", .meaning = "sampling "
                                                                                                       "period",
       .role = Role::amplitude, .typical = {0.1e-3, 4e-3}},
      {.name = "phase", .unit = "1", .si_unit = "1", .limits = {0.0, 1.0},
       .meaning = "time from the start of the feed to the first sample, as a share of the period", .role = Role::shape,
       .typical = {0, 1, "rectangular where the clocks are free"}},
  };
  static constexpr EffectCard card{
      .name = "sampling_rate",
      .title = "Sampling of the receiver",
      .stage = Stage::timing,
      .meaning = "The receiver holds a trigger, so that none is missed, until it is sampled next: a latency between "
                 "zero and one period. A phase drawn from 0 to 1 makes it rectangular. The reading is a step function "
                 "without a derivative; the engine gives that of its mean (half a period) and, for the phase, one "
                 "period, which for a phase from 0 to 1 is the rectangle's uncertainty.",
      .adds = "sampling_period += period; sampling_phase += phase",
      .confused_with = "trigger_latency, of half a period",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities,
      .moves_in_steps = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.sampling_period = tool.sampling_period + q[0];
    tool.sampling_phase = tool.sampling_phase + q[1];
  }
};

} // namespace gumshoe::effects
