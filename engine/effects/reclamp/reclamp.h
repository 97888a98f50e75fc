#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Seat of the tool holder. Where the taper seats at this clamping; positive is a longer tool. Give it a standard
/// uncertainty per clamp: that scatter is what matters.
struct Reclamp {
  static constexpr QuantityCard quantities[] = {
      {"shift",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "tool longer by this much in this clamping",
       Role::amplitude,
       "1-3 um"},
  };
  static constexpr EffectCard card{"reclamp",
                                   "Seat of the tool holder",
                                   "pose",
                                   40,
                                   "",
                                   "Where the taper seats at this clamping; positive is a longer tool. Give it a "
                                   "standard uncertainty per clamp: that scatter is what matters.",
                                   "everything constant within a clamping if each rod is clamped once",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_growth = event.tool_growth + q[0];
  }
};

} // namespace gumshoe::effects
