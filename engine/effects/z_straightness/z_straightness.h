#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A bowed guideway of Z: its slide strays across by the square of its position.
struct ZStraightness {
  static constexpr QuantityCard quantities[] = {
      {"E_XZ",
       "um/m2",
       "1/m",
       0.0,
       {-1e-1, 1e-1},
       "E_XZ",
       "along X, per square of the position",
       Role::amplitude,
       "20-200 um/m2"},
      {"E_YZ",
       "um/m2",
       "1/m",
       0.0,
       {-1e-1, 1e-1},
       "E_YZ",
       "along Y, per square of the position",
       Role::amplitude,
       "20-200 um/m2"},
  };
  static constexpr EffectCard card{
      "z_straightness",
      "Straightness of Z",
      "slides",
      32,
      "E_XZ, E_YZ",
      "The guideway is bowed: actual minus commanded along X and Y grows with the square of the commanded Z. 80 um/m2 "
      "are 5 um over 0.5 m. What is linear is squareness.",
      "second harmonics of C, as a square is one on a circle; squareness and offsets over a short travel",
      "engineering knowledge; ISO 230-1",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T square = r.position.z * r.position.z;
    r.X.error = r.X.error + q[0] * square;
    r.Y.error = r.Y.error + q[1] * square;
  }
};

} // namespace gumshoe::effects
