#pragma once
#include "chain/contouring.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct SamplingJitter {
  static constexpr QuantityCard quantities[] = {
      {.name = "delay", .unit = "us", .si_unit = "s", .limits = {-1, 1},
       .meaning = "moment at which all bars are read minus the commanded one", .role = Role::amplitude,
       .typical = {10e-6, 500e-6, "1.5 um at 889 mm/min for 100 us"}}};
  static constexpr EffectCard card{
      .name = "sampling_jitter",
      .title = "Moment at which all bars are read",
      .stage = Stage::contouring,
      .meaning = "All bars are read together, but not at the commanded moment: the tool is taken to be where it is "
                 "delay later. Draws per reading are jitter; one draw for all readings is a delay of the clock.",
      .adds = "delay += delay",
      .confused_with = "skew_1, skew_2 and skew_3, exactly, if all three are equal; loop_gain at constant feed",
      .source = "engineering knowledge; Schmitz and Ziegert 1999, section 3 for the sampling at 1 kHz",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.contouring->delay = event.contouring->delay + q[0];
  }
};

} // namespace gumshoe::effects
