#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Three-lobed pretravel of a kinematic seat, in the probe's frame.
struct PretravelLobing {
  static constexpr QuantityCard quantities[] = {
      {"cosine",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "a_3",
       "where the approach is along the probe's X",
       Role::pair,
       "1-10 um"},
      {"sine", "um", "m", 0.0, {-1e-3, 1e-3}, "a_3", "where it is 30 deg from X towards Y", Role::pair, "1-10 um"},
  };
  static constexpr EffectCard card{
      "pretravel_lobing",
      "Lobing of the probe's pretravel",
      "contact",
      30,
      "",
      "The three supports of a kinematic seat give pretravel three lobes over the approach's azimuth phi in the "
      "probe's frame, which turns with B and C: sin^3(theta) (cosine cos 3 phi + sine sin 3 phi), theta from the "
      "stylus. The sines keep it smooth where the approach is along the stylus: at the top of a sphere it shows only "
      "where B has turned the probe.",
      "harmonics of C, form of the sphere; pretravel_bending while C stands still",
      "Estler et al. 1996, Precision Engineering (three lobes of a kinematic seat); the smooth shape: engineering "
      "knowledge",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const Vector3<T>& u = r.approach;
    const T c = u.x * u.x, s = u.y * u.y;
    r.pretravel = r.pretravel + (q[0] * (u.x * (c - 3.0 * s)) + q[1] * (u.y * (3.0 * c - s)));
  }
};

} // namespace gumshoe::effects
