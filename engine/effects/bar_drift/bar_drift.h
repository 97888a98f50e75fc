#pragma once
#include "chain/ball_bar.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct BarDrift {
  static constexpr QuantityCard quantities[] = {
      {.name = "rate", .unit = "um/h", .si_unit = "m/s", .limits = {-1e-6, 1e-6}, .meaning = "of the indication",
       .role = Role::amplitude, .typical = {1e-6 / 3600, 10e-6 / 3600}},
  };
  static constexpr EffectCard card{
      .name = "bar_drift",
      .title = "Drift of a ball bar",
      .stage = Stage::bar,
      .meaning = "The indication of a bar of constant length rises evenly with time: warming of its sensor and of the "
                 "sockets.",
      .adds = "bar.zero += rate time",
      .confused_with = "the order of the stations; temperature of the bar; drift of the machine along the bar",
      .source = "engineering knowledge; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.bar->zero = event.bar->zero + q[0] * event.time;
  }
};

} // namespace gumshoe::effects
