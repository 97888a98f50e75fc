#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// More pretravel where the approach bends the stylus than where it pushes along it.
struct PretravelBending {
  static constexpr QuantityCard quantities[] = {
      {"distance",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "more across the stylus than along it",
       Role::amplitude,
       "1-10 um"},
  };
  static constexpr EffectCard card{
      "pretravel_bending",
      "Pretravel by bending of the stylus",
      "contact",
      20,
      "",
      "Pretravel grows with sin^2 of the angle between approach and stylus (the probe's Z): a bending force and the "
      "deflection along the approach each go with its sine. At the top of a sphere the angle is that of B.",
      "E_Z0B over a short range of B; gravity_sag where B has one sign",
      "Estler et al. 1996, Precision Engineering (stylus bending); the smooth shape: engineering knowledge",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const Vector3<T>& u = r.approach;
    r.pretravel = r.pretravel + q[0] * (u.x * u.x + u.y * u.y);
  }
};

} // namespace gumshoe::effects
