#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct Reclamp {
  static constexpr QuantityCard quantities[] = {
      {.name = "shift", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "additional length of the tool in this clamping", .role = Role::amplitude, .typical = {1e-6, 3e-6}},
  };
  static constexpr EffectCard card{
      .name = "reclamp",
      .title = "Seat of the tool holder",
      .stage = Stage::pose,
      .meaning = "Position of the taper in its seat at this clamping; positive for a longer tool. State its standard "
                 "uncertainty "
                 "per clamping, since its scatter is what matters.",
      .adds = "tool_growth += shift",
      .confused_with = "everything constant within a clamping if each rod is clamped once",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      .quantities = quantities,
      .scatters_between_clampings = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_growth = event.tool_growth + q[0];
  }
};

} // namespace gumshoe::effects
