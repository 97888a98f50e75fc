#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A bowed guideway of X: its slide strays across by the square of its position.
struct XStraightness {
  static constexpr QuantityCard quantities[] = {
      {"E_YX",
       "um/m2",
       "1/m",
       0.0,
       {-1e-1, 1e-1},
       "E_YX",
       "along Y, per square of the position",
       Role::amplitude,
       "20-200 um/m2"},
      {"E_ZX",
       "um/m2",
       "1/m",
       0.0,
       {-1e-1, 1e-1},
       "E_ZX",
       "along Z, per square of the position",
       Role::amplitude,
       "20-200 um/m2"},
  };
  static constexpr EffectCard card{
      "x_straightness",
      "Straightness of X",
      "slides",
      30,
      "E_YX, E_ZX",
      "The guideway is bowed: actual minus commanded along Y and Z grows with the square of the commanded X. 80 um/m2 "
      "are 5 um over 0.5 m. What is linear is squareness.",
      "second harmonics of C, as a square is one on a circle; squareness and offsets over a short travel",
      "engineering knowledge; ISO 230-1",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T square = r.position.x * r.position.x;
    r.Y.error = r.Y.error + q[0] * square;
    event.axis_error = event.axis_error + q[1] * square;
  }
};

} // namespace gumshoe::effects
