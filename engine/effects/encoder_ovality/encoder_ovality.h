#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A graduation strained into an ellipse, or read by two opposed heads, which cancel the first harmonic: second
/// harmonic of the angular positioning error.
struct EncoderOvality {
  static constexpr QuantityCard quantities[] = {
      {"cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 0 deg", Role::pair, "1-10 arcsec"},
      {"sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 45 deg", Role::pair, "1-10 arcsec"},
  };
  static constexpr EffectCard card(std::string_view name, std::string_view title, int rank, std::string_view symbol,
                                   std::string_view confused_with) {
    return {name,
            title,
            "rotary",
            rank,
            symbol,
            "Second harmonic of the angular positioning error, cosine cos(2 angle) + sine sin(2 angle) of the "
            "commanded angle: the graduation is strained, or two opposed heads cancel its eccentricity.",
            confused_with,
            "engineering knowledge; ISO 230-1",
            quantities};
  }
  template <class T> static void add(const T* q, const T& angle, T& error) {
    error = error + (q[0] * num::cos(2.0 * angle) + q[1] * num::sin(2.0 * angle));
  }
};

struct BEncoderOvality {
  static constexpr EffectCard card = EncoderOvality::card("b_encoder_ovality", "Oval encoder of the B axis", 20, "E_BB",
                                                          "b_encoder_eccentricity over a short range of B");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    EncoderOvality::add(q, r.B, r.B_error[chain::E_B]);
  }
};

struct CEncoderOvality {
  static constexpr EffectCard card =
      EncoderOvality::card("c_encoder_ovality", "Oval encoder of the C axis", 21, "E_CC",
                           "c_encoder_eccentricity over a quarter turn; c_radial_motion");
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    EncoderOvality::add(q, r.C, r.C_error[chain::E_C]);
  }
};

} // namespace gumshoe::effects
