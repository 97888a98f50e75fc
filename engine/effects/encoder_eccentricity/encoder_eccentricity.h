#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Eccentricity of a rotary axis' graduation against its bearing: its angular positioning error goes with the first
/// harmonic of the commanded angle. E micrometres on a graduation of D millimetres make 412 E / D arcsec.
struct EncoderEccentricity {
  static constexpr QuantityCard quantities[] = {
      {"cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 0 deg", Role::pair, "2-20 arcsec"},
      {"sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 90 deg", Role::pair, "2-20 arcsec"},
  };
  static constexpr EffectCard card(std::string_view name, std::string_view title, int rank, std::string_view symbol,
                                   std::string_view confused_with) {
    return {name,
            title,
            "rotary",
            rank,
            symbol,
            "The graduation turns beside its bearing's centre: the angular positioning error is cosine cos(angle) + "
            "sine sin(angle) of the commanded angle. Of e um on a graduation of D mm: 412 e / D arcsec.",
            confused_with,
            "HEIDENHAIN, angle encoders without bearing: error 412 e / D; ISO 230-1",
            quantities};
  }
  template <class T> static void add(const T* q, const T& angle, T& error) {
    error = error + (q[0] * num::cos(angle) + q[1] * num::sin(angle));
  }
};

struct BEncoderEccentricity {
  static constexpr EffectCard card =
      EncoderEccentricity::card("b_encoder_eccentricity", "Eccentric encoder of the B axis", 10, "E_BB",
                                "E_X0B, E_Z0B over a short range of B; b_encoder_ovality; gravity_sag");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    EncoderEccentricity::add(q, r.B, r.B_error[chain::E_B]);
  }
};

struct CEncoderEccentricity {
  static constexpr EffectCard card =
      EncoderEccentricity::card("c_encoder_eccentricity", "Eccentric encoder of the C axis", 11, "E_CC",
                                "E_X0C, E_Y0C over a quarter turn; c_encoder_ovality");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    EncoderEccentricity::add(q, r.C, r.C_error[chain::E_C]);
  }
};

} // namespace gumshoe::effects
