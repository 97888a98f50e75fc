#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Linear positioning error of Z. Actual minus commanded position grows in proportion to the commanded Z.
struct ZScale {
  static constexpr QuantityCard quantities[] = {
      {"E_ZZ",
       "um/m",
       "1",
       0.0,
       {-1e-2, 1e-2},
       "E_ZZ",
       "positioning error per length of travel",
       Role::amplitude,
       "5-20 um/m"},
  };
  static constexpr EffectCard card{"z_scale",
                                   "Linear positioning error of Z",
                                   "motion",
                                   30,
                                   "E_ZZ",
                                   "Actual minus commanded position grows in proportion to the commanded Z.",
                                   "rod_expansion (exactly collinear where spindle_z minus rod_length is constant)",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-1",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.axis_scale = event.axis_scale + q[0];
  }
};

} // namespace gumshoe::effects
