#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct PretravelLobing {
  static constexpr QuantityCard quantities[] = {
      {.name = "cosine", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .symbol = "a_3",
       .meaning = "lobe for an approach along the probe's X", .role = Role::pair, .typical = {1e-6, 10e-6}},
      {.name = "sine", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .symbol = "a_3",
       .meaning = "lobe for an approach 30 deg from X towards Y", .role = Role::pair, .typical = {1e-6, 10e-6}},
  };
  static constexpr EffectCard card{
      .name = "pretravel_lobing",
      .title = "Lobing of the probe's pretravel",
      .stage = Stage::contact,
      .meaning = "The three supports of a kinematic seat give pretravel three lobes over the approach's azimuth phi "
                 "in the probe's frame, which turns with B and C: sin^3(theta) (cosine cos 3 phi + sine sin 3 phi), "
                 "with theta from the stylus. The sines keep it smooth for an approach along the stylus: at the top "
                 "of a sphere it acts only if B has turned the probe.",
      .adds = "pretravel += sin^3 theta (cosine cos 3 phi + sine sin 3 phi) (phi: azimuth of the approach)",
      .confused_with = "harmonics of C, form of the sphere; pretravel_bending while C stands still",
      .source = "Estler et al. 1996, Precision Engineering (three lobes of a kinematic seat); the smooth shape: "
                "engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const Vector3<T>& u = event.approach_in_probe;
    const T c = u.x * u.x, s = u.y * u.y;
    event.pretravel = event.pretravel + (q[0] * (u.x * (c - 3.0 * s)) + q[1] * (u.y * (3.0 * c - s)));
  }
};

} // namespace gumshoe::effects
