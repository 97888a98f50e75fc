#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct GravitySag {
  static constexpr QuantityCard quantities[] = {
      {.name = "drop", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = "drop of the B axis at B = "
                                                                                         "90 deg",
       .role = Role::amplitude, .typical = {1e-6, 20e-6}},
  };
  static constexpr EffectCard card{
      .name = "gravity_sag",
      .title = "Gravity sag of the components carried by B",
      .stage = Stage::rotary,
      .iso230 = "E_ZB",
      .meaning = "The weight carried by B moves outwards with sin B and its carrier deflects: the B axis is lower "
                 "by drop sin(B).",
      .adds = "E_ZB -= drop sin B",
      .confused_with = "E_X0B and E_Z0B over a short range of B; the sine of b_encoder_eccentricity",
      .source = "engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryMotion<T>& r = event.rotary->B;
    r.error[chain::E_Z] = r.error[chain::E_Z] - q[0] * num::sin(r.angle);
  }
};

} // namespace gumshoe::effects
