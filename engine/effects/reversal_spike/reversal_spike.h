#pragma once
#include "chain/contouring.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A row of the card.
struct SpikeHeight {
  static constexpr QuantityCard height(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning,
            .role = Role::amplitude, .typical = {1e-6, 15e-6}};
  }
};

struct ReversalSpike {
  static constexpr QuantityCard quantities[] = {
      SpikeHeight::height("x", "height on X"), SpikeHeight::height("y", "height on Y"), SpikeHeight::height("z", "height on Z"),
      {.name = "rise", .unit = "ms", .si_unit = "s", .default_value = 0.02, .limits = {1e-4, 10},
       .meaning = "from the reversal to the height of the spike", .role = Role::shape, .typical = {5e-3, 50e-3}}};
  static constexpr EffectCard card{
      .name = "reversal_spike",
      .title = "Reversal spikes",
      .stage = Stage::contouring,
      .meaning = "Friction changes its sign where a slide turns round, and the slide stays behind until its servo has "
                 "made up for it: actual minus commanded is -direction height (t / rise) exp(1 - t / rise), t after the "
                 "reversal. On a circle the spike points outwards.",
      .adds = "x.error -= x.direction x (t / rise) exp(1 - t / rise); y.error, z.error likewise",
      .confused_with = "x_reversal and y_reversal, which stay; noise, if readings are further apart than its width",
      .source = "engineering knowledge; ISO 230-4; Schmitz and Ziegert 1999, section 4 for the reversal of X",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const auto act = [&](const T& height, const chain::Following<T>& following, chain::Slide<T>& slide) {
      const T t = following.since_reversal / q[3];
      slide.error = slide.error - slide.direction * (height * (t * num::exp(1.0 - t)));
    };
    const chain::Contouring<T>& c = *event.contouring;
    act(q[0], c.x, event.x), act(q[1], c.y, event.y), act(q[2], c.z, event.z);
  }
};

} // namespace gumshoe::effects
