#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Way of the tip from contact to trigger, the same in all directions.
struct Pretravel {
  static constexpr QuantityCard quantities[] = {
      {"distance",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "on along the approach from contact to trigger",
       Role::amplitude,
       "2-20 um"},
  };
  static constexpr EffectCard card{
      "pretravel",
      "Pretravel of the probe",
      "contact",
      10,
      "",
      "The tip moves on by this distance from contact to trigger, along the approach, whatever its direction.",
      "sphere_radius + tip_radius and probe_z, exactly where every approach is from the top",
      "Estler et al. 1996, Precision Engineering; size: engineering knowledge",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    r.pretravel = r.pretravel + q[0];
  }
};

} // namespace gumshoe::effects
