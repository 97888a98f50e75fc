#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Sag under the weight that B carries: as B swings it out, its carrier gives way and the B axis stands lower.
struct GravitySag {
  static constexpr QuantityCard quantities[] = {
      {"drop", "um", "m", 0.0, {-1e-3, 1e-3}, "", "of the B axis at 90 deg", Role::amplitude, "1-20 um"},
  };
  static constexpr EffectCard card{"gravity_sag",
                                   "Gravity sag of what B carries",
                                   "rotary",
                                   60,
                                   "E_ZB",
                                   "The weight that B carries swings out with sin B and its carrier gives way: the B "
                                   "axis stands lower by drop sin(B).",
                                   "E_X0B and E_Z0B over a short range of B; the sine of b_encoder_eccentricity",
                                   "engineering knowledge",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    r.B_error[chain::E_Z] = r.B_error[chain::E_Z] - q[0] * num::sin(r.B);
  }
};

} // namespace gumshoe::effects
