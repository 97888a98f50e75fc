#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Tilt error motion of the C axis, second harmonic: E_AC and E_BC about the axis' point. The first harmonic is an
/// orientation of the axis or of the probe.
struct CTiltMotion {
  static constexpr QuantityCard quantities[] = {
      {"a_cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "about X, of cosine 2 C", Role::pair, "1-10 arcsec"},
      {"a_sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "about X, of sine 2 C", Role::pair, "1-10 arcsec"},
      {"b_cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "about Y, of cosine 2 C", Role::pair, "1-10 arcsec"},
      {"b_sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "about Y, of sine 2 C", Role::pair, "1-10 arcsec"},
  };
  static constexpr EffectCard card{"c_tilt_motion",
                                   "Tilt error motion of the C axis",
                                   "rotary",
                                   52,
                                   "E_AC, E_BC",
                                   "The C axis tilts twice per turn about X and Y, E_AC = a_cosine cos 2C + a_sine sin "
                                   "2C and E_BC likewise, about the axis' point at the height of the origin.",
                                   "c_radial_motion and c_axial_motion together: one probe length has one lever",
                                   "engineering knowledge; ISO 230-7 for the error motion",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T c = num::cos(2.0 * r.C), s = num::sin(2.0 * r.C);
    r.C_error[chain::E_A] = r.C_error[chain::E_A] + (q[0] * c + q[1] * s);
    r.C_error[chain::E_B] = r.C_error[chain::E_B] + (q[2] * c + q[3] * s);
  }
};

} // namespace gumshoe::effects
