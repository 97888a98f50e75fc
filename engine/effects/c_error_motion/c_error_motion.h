#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Second harmonics of the error motions of C. First harmonics are offsets and orientations of axis and probe.
/// The error of the given kind takes q[0] cos 2C + q[1] sin 2C, the next kind q[2] and q[3] likewise.
template <chain::ErrorKind kind, int kinds> struct CErrorMotion {
  static constexpr QuantityCard um(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning,
            .role = Role::pair, .typical = {1e-6, 10e-6}};
  }
  static constexpr QuantityCard angle(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "arcsec", .si_unit = "rad", .limits = {-1e-2, 1e-2}, .meaning = meaning,
            .role = Role::pair, .typical = {1 * arcsec, 10 * arcsec}};
  }
  static constexpr std::string_view source = "engineering knowledge; ISO 230-7 for the error motion";
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryMotion<T>& r = event.rotary->C;
    const T c = num::cos(2.0 * r.angle), s = num::sin(2.0 * r.angle);
    for (int i = 0; i < kinds; ++i) r.error[kind + i] = r.error[kind + i] + (q[2 * i] * c + q[2 * i + 1] * s);
  }
};

struct CRadialMotion : CErrorMotion<chain::E_X, 2> {
  static constexpr QuantityCard quantities[] = {
      um("x_cosine", "along X, of cosine 2 C"), um("x_sine", "along X, of sine 2 C"),
      um("y_cosine", "along Y, of cosine 2 C"), um("y_sine", "along Y, of sine 2 C")};
  static constexpr EffectCard card{
      .name = "c_radial_motion",
      .title = "Radial error motion of the C axis",
      .stage = Stage::rotary,
      .iso230 = "E_XC, E_YC",
      .meaning = "The C axis moves along X and Y twice per turn, E_XC = x_cosine cos 2C + x_sine sin 2C and E_YC "
                 "likewise, in the frame that B turns: an oval bearing seat.",
      .adds = "E_XC += x_cosine cos 2C + x_sine sin 2C; E_YC likewise by y",
      .confused_with =
          "c_encoder_ovality; S_XY, which is a second harmonic on a circle; sphere off the A axis",
      .source = source,
      .quantities = quantities};
};

struct CAxialMotion : CErrorMotion<chain::E_Z, 1> {
  static constexpr QuantityCard quantities[] = {um("cosine", "along the axis, of cosine 2 C"),
                                                um("sine", "along the axis, of sine 2 C")};
  static constexpr EffectCard card{
      .name = "c_axial_motion",
      .title = "Axial error motion of the C axis",
      .stage = Stage::rotary,
      .iso230 = "E_ZC",
      .meaning = "The C axis moves along itself twice per turn, E_ZC = cosine cos 2C + sine sin 2C.",
      .adds = "E_ZC += cosine cos 2C + sine sin 2C",
      .confused_with = "c_tilt_motion; E_A0C, E_B0C over a quarter turn",
      .source = source,
      .quantities = quantities};
};

struct CTiltMotion : CErrorMotion<chain::E_A, 2> {
  static constexpr QuantityCard quantities[] = {
      angle("a_cosine", "about X, of cosine 2 C"), angle("a_sine", "about X, of sine 2 C"),
      angle("b_cosine", "about Y, of cosine 2 C"), angle("b_sine", "about Y, of sine 2 C")};
  static constexpr EffectCard card{
      .name = "c_tilt_motion",
      .title = "Tilt error motion of the C axis",
      .stage = Stage::rotary,
      .iso230 = "E_AC, E_BC",
      .meaning = "The C axis tilts twice per turn about X and Y, E_AC = a_cosine cos 2C + a_sine sin 2C and E_BC "
                 "likewise, about the axis' point at the height of the origin.",
      .adds = "E_AC += a_cosine cos 2C + a_sine sin 2C; E_BC likewise by b",
      .confused_with = "c_radial_motion and c_axial_motion together: one probe length has one lever",
      .source = source,
      .quantities = quantities};
};

} // namespace gumshoe::effects
