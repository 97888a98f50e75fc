#pragma once
#include "effects/part.h"

namespace gumshoe::effects {

/// Positioning error of a rotary axis that is a harmonic of its commanded angle.
template <int order> struct EncoderHarmonic {
  static constexpr QuantityCard row(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "arcsec", .si_unit = "rad", .limits = {-1e-2, 1e-2}, .meaning = meaning,
            .role = Role::pair, .typical = {(order == 1 ? 2 : 1) * arcsec, (order == 1 ? 20 : 10) * arcsec}};
  }
  static constexpr QuantityCard quantities[] = {row("cosine", "error at 0 deg"),
                                                row("sine", order == 1 ? "error at 90 deg" : "error at 45 deg")};
  template <class T> static void add(const T* q, const Turn<T>& turn) {
    const T angle = order == 1 ? turn.axis.angle : order * 1.0 * turn.axis.angle;
    turn.error = turn.error + (q[0] * num::cos(angle) + q[1] * num::sin(angle));
  }
};

struct EncoderEccentricity : EncoderHarmonic<1> {
  static constexpr Common common{
      .stage = Stage::rotary,
      .meaning = "The centre of the graduation does not coincide with that of the bearing: the angular positioning "
                 "error is cosine "
                 "cos(angle) + sine sin(angle) of the commanded angle. An eccentricity of e um on a graduation of D "
                 "mm gives 412 e / D arcsec.",
      .source = "HEIDENHAIN, angle encoders without bearing: error 412 e / D; ISO 230-1",
      .quantities = quantities};
};
struct BEncoderEccentricity : On<EncoderEccentricity, axis_B> {
  static constexpr EffectCard card =
      on({.name = "b_encoder_eccentricity", .title = "Eccentric encoder of the B axis", .iso230 = "E_BB",
          .adds = "E_BB += cosine cos B + sine sin B",
          .confused_with = "E_X0B, E_Z0B over a short range of B; b_encoder_ovality; gravity_sag"},
         EncoderEccentricity::common);
};
struct CEncoderEccentricity : On<EncoderEccentricity, axis_C> {
  static constexpr EffectCard card =
      on({.name = "c_encoder_eccentricity", .title = "Eccentric encoder of the C axis", .iso230 = "E_CC",
          .adds = "E_CC += cosine cos C + sine sin C",
          .confused_with = "E_X0C, E_Y0C over a quarter turn; c_encoder_ovality"},
         EncoderEccentricity::common);
};

struct EncoderOvality : EncoderHarmonic<2> {
  static constexpr Common common{
      .stage = Stage::rotary,
      .meaning = "Second harmonic of the angular positioning error, cosine cos(2 angle) + sine sin(2 angle) of the "
                 "commanded angle: the graduation is strained, or two opposed heads cancel its eccentricity.",
      .source = "engineering knowledge; ISO 230-1",
      .quantities = quantities};
};
struct BEncoderOvality : On<EncoderOvality, axis_B> {
  static constexpr EffectCard card =
      on({.name = "b_encoder_ovality", .title = "Oval encoder of the B axis", .iso230 = "E_BB",
          .adds = "E_BB += cosine cos 2B + sine sin 2B",
          .confused_with = "b_encoder_eccentricity over a short range of B"},
         EncoderOvality::common);
};
struct CEncoderOvality : On<EncoderOvality, axis_C> {
  static constexpr EffectCard card =
      on({.name = "c_encoder_ovality", .title = "Oval encoder of the C axis", .iso230 = "E_CC",
          .adds = "E_CC += cosine cos 2C + sine sin 2C",
          .confused_with = "c_encoder_eccentricity over a quarter turn; c_radial_motion"},
         EncoderOvality::common);
};

/// The form of an eccentric encoder by another cause: only the load tells them apart.
struct BGravityTorque : On<EncoderEccentricity, axis_B> {
  static constexpr EffectCard card{
      .name = "b_gravity_torque",
      .title = "Twist of the B axis under its load",
      .stage = Stage::rotary,
      .iso230 = "E_BB",
      .meaning = "The centre of gravity of what B carries lies off its axis. The drive yields to the torque: an angular "
                 "positioning error cosine cos B + sine sin B that grows with the load.",
      .adds = "E_BB += cosine cos B + sine sin B",
      .confused_with = "b_encoder_eccentricity, exactly, unless the load is changed; gravity_sag",
      .source = "engineering knowledge; ISO 230-1",
      .quantities = EncoderEccentricity::quantities};
};

} // namespace gumshoe::effects
