#pragma once
#include "chain/contouring.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct BracketInertia {
  static constexpr QuantityCard quantities[] = {
      {.name = "compliance", .unit = "um/(m/s2)", .si_unit = "s2", .limits = {-1e-3, 1e-3},
       .meaning = "deflection by acceleration: moved mass over stiffness", .role = Role::amplitude,
       .typical = {0.05e-6, 0.5e-6, "1 um at 4.91 m/s2 for 0.2 um/(m/s2)", true}}};
  static constexpr EffectCard card{
      .name = "bracket_inertia",
      .title = "Inertia that bends the bracket of the tool's ball",
      .stage = Stage::contouring,
      .meaning = "The bracket gives way to the inertia of ball and bars: the ball stands off the tool by -compliance "
                 "times the acceleration of the slides.",
      .adds = "compliance += compliance",
      .confused_with = "sampling_jitter and loop_gain while the feed changes; the radius of a circle, which reads larger",
      .source = "Schmitz and Ziegert 1999, section 2: about 1 um under maximum loads; that it is inertia is assumed",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.contouring->compliance = event.contouring->compliance + q[0];
  }
};

} // namespace gumshoe::effects
