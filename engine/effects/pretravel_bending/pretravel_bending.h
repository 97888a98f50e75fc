#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct PretravelBending {
  static constexpr QuantityCard quantities[] = {
      {.name = "distance", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "additional pretravel across the stylus, compared with along it", .role = Role::amplitude,
       .typical = {1e-6, 10e-6}},
  };
  static constexpr EffectCard card{
      .name = "pretravel_bending",
      .title = "Pretravel by bending of the stylus",
      .stage = Stage::contact,
      .meaning = "Pretravel grows with sin^2 of the angle between approach and stylus (the probe's Z): the bending "
                 "force and the deflection along the approach are each proportional to its sine. At the top of a "
                 "sphere this angle "
                 "is that of B.",
      .adds = "pretravel += distance sin^2 theta (theta: between approach and stylus)",
      .confused_with = "E_Z0B over a short range of B; gravity_sag if B has only one sign",
      .source = "Estler et al. 1996, Precision Engineering (stylus bending); the smooth shape: engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const Vector3<T>& u = event.approach_in_probe;
    event.pretravel = event.pretravel + q[0] * (u.x * u.x + u.y * u.y);
  }
};

} // namespace gumshoe::effects
