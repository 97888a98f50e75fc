#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Linear positioning error of Y. Actual minus commanded position grows in proportion to the commanded Y.
struct YScale {
  static constexpr QuantityCard quantities[] = {
      {"E_YY",
       "um/m",
       "1",
       0.0,
       {-1e-2, 1e-2},
       "E_YY",
       "positioning error per length of travel",
       Role::amplitude,
       "5-20 um/m"},
  };
  static constexpr EffectCard card{
      "y_scale",
      "Linear positioning error of Y",
      "slides",
      21,
      "E_YY",
      "Actual minus commanded position grows in proportion to the commanded Y. The quantity E_YY of a model is an "
      "error at one place and adds to the reading.",
      "lengths of the probe and links; the other slides' scales, as all three together are a scale of the whole",
      "engineering knowledge; ISO 230-1",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    r.Y.scale = r.Y.scale + q[0];
  }
};

} // namespace gumshoe::effects
