#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Radial error motion of the C axis, second harmonic: E_XC and E_YC in the frame of the B axis' component. The first
/// harmonic is an offset of the axis or of the probe.
struct CRadialMotion {
  static constexpr QuantityCard quantities[] = {
      {"x_cosine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along X, of cosine 2 C", Role::pair, "1-10 um"},
      {"x_sine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along X, of sine 2 C", Role::pair, "1-10 um"},
      {"y_cosine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along Y, of cosine 2 C", Role::pair, "1-10 um"},
      {"y_sine", "um", "m", 0.0, {-1e-3, 1e-3}, "", "along Y, of sine 2 C", Role::pair, "1-10 um"},
  };
  static constexpr EffectCard card{
      "c_radial_motion",
      "Radial error motion of the C axis",
      "rotary",
      50,
      "E_XC, E_YC",
      "The C axis moves along X and Y twice per turn, E_XC = x_cosine cos 2C + x_sine sin 2C and E_YC likewise, in the "
      "frame that B turns: an oval bearing seat.",
      "c_encoder_ovality; S_XY, which is a second harmonic on a circle; sphere off the A axis",
      "engineering knowledge; ISO 230-7 for the error motion",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T c = num::cos(2.0 * r.C), s = num::sin(2.0 * r.C);
    r.C_error[chain::E_X] = r.C_error[chain::E_X] + (q[0] * c + q[1] * s);
    r.C_error[chain::E_Y] = r.C_error[chain::E_Y] + (q[2] * c + q[3] * s);
  }
};

} // namespace gumshoe::effects
