#pragma once
#include "effects/per_rotary_axis.h"

namespace gumshoe::effects {

/// Eccentricity of a rotary axis' graduation against its bearing: its angular positioning error goes with the first
/// harmonic of the commanded angle. E micrometres on a graduation of D millimetres make 412 E / D arcsec.
struct EncoderEccentricity {
  static constexpr QuantityCard quantities[] = {
      {"cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 0 deg", Role::pair, "2-20 arcsec"},
      {"sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 90 deg", Role::pair, "2-20 arcsec"},
  };
  static constexpr EffectCard common{
      "",
      "",
      "rotary",
      10,
      "",
      "The graduation turns beside its bearing's centre: the angular positioning error is cosine cos(angle) + "
      "sine sin(angle) of the commanded angle. Of e um on a graduation of D mm: 412 e / D arcsec.",
      "",
      "HEIDENHAIN, angle encoders without bearing: error 412 e / D; ISO 230-1",
      quantities};
  template <class T> static void add(const T* q, const RotaryAxis<T>& axis) {
    axis.error = axis.error + (q[0] * num::cos(axis.angle) + q[1] * num::sin(axis.angle));
  }
};

struct BEncoderEccentricity : OfB<EncoderEccentricity> {
  static constexpr EffectCard card =
      of_axis(EncoderEccentricity::common, 'B', "b_encoder_eccentricity", "Eccentric encoder of the B axis",
              "E_X0B, E_Z0B over a short range of B; b_encoder_ovality; gravity_sag");
};

struct CEncoderEccentricity : OfC<EncoderEccentricity> {
  static constexpr EffectCard card =
      of_axis(EncoderEccentricity::common, 'C', "c_encoder_eccentricity", "Eccentric encoder of the C axis",
              "E_X0C, E_Y0C over a quarter turn; c_encoder_ovality");
};

} // namespace gumshoe::effects
