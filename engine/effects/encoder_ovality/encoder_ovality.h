#pragma once
#include "effects/per_rotary_axis.h"

namespace gumshoe::effects {

/// A graduation strained into an ellipse, or read by two opposed heads, which cancel the first harmonic: second
/// harmonic of the angular positioning error.
struct EncoderOvality {
  static constexpr QuantityCard quantities[] = {
      {"cosine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 0 deg", Role::pair, "1-10 arcsec"},
      {"sine", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "", "error at 45 deg", Role::pair, "1-10 arcsec"},
  };
  static constexpr EffectCard common{
      "",
      "",
      "rotary",
      20,
      "",
      "Second harmonic of the angular positioning error, cosine cos(2 angle) + sine sin(2 angle) of the "
      "commanded angle: the graduation is strained, or two opposed heads cancel its eccentricity.",
      "",
      "engineering knowledge; ISO 230-1",
      quantities};
  template <class T> static void add(const T* q, const RotaryAxis<T>& axis) {
    axis.error = axis.error + (q[0] * num::cos(2.0 * axis.angle) + q[1] * num::sin(2.0 * axis.angle));
  }
};

struct BEncoderOvality : OfB<EncoderOvality> {
  static constexpr EffectCard card =
      of_axis(EncoderOvality::common, 'B', "b_encoder_ovality", "Oval encoder of the B axis",
              "b_encoder_eccentricity over a short range of B");
};

struct CEncoderOvality : OfC<EncoderOvality> {
  static constexpr EffectCard card =
      of_axis(EncoderOvality::common, 'C', "c_encoder_ovality", "Oval encoder of the C axis",
              "c_encoder_eccentricity over a quarter turn; c_radial_motion");
};

} // namespace gumshoe::effects
