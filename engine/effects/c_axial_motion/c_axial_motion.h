#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Axial error motion of the C axis, second harmonic. The first harmonic of the probe's Z is an orientation of the
/// axis.
struct CAxialMotion {
  static constexpr QuantityCard quantities[] = {
      {"cosine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along the axis, of cosine 2 C", Role::pair, "1-10 um"},
      {"sine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along the axis, of sine 2 C", Role::pair, "1-10 um"},
  };
  static constexpr EffectCard card{"c_axial_motion",
                                   "Axial error motion of the C axis",
                                   "rotary",
                                   51,
                                   "E_ZC",
                                   "The C axis moves along itself twice per turn, E_ZC = cosine cos 2C + sine sin 2C.",
                                   "c_tilt_motion; E_A0C, E_B0C over a quarter turn",
                                   "engineering knowledge; ISO 230-7 for the error motion",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T c = num::cos(2.0 * r.C), s = num::sin(2.0 * r.C);
    r.C_error[chain::E_Z] = r.C_error[chain::E_Z] + (q[0] * c + q[1] * s);
  }
};

} // namespace gumshoe::effects
