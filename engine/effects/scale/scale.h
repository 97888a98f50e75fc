#pragma once
#include "effects/part.h"

namespace gumshoe::effects {

struct Scale {
  static constexpr QuantityCard row(std::string_view symbol) {
    return {.name = symbol, .unit = "um/m", .si_unit = "1", .limits = {-1e-2, 1e-2}, .symbol = symbol,
            .meaning = "positioning error per length of travel", .role = Role::amplitude, .typical = {5e-6, 20e-6}};
  }
  static constexpr Common common(std::span<const QuantityCard> quantities) {
    return {.stage = Stage::slides,
            .meaning = "Actual minus commanded position grows in proportion to the command. A model's quantity of "
                       "this symbol is an error at one place and is added to the reading.",
            .source = "engineering knowledge; ISO 230-1",
            .quantities = quantities};
  }
  static constexpr std::string_view confused_with =
      "lengths of the probe and links; the other slides' scales, as all three together are a scale of the whole";
  template <class T> static void add(const T* q, chain::Slide<T>& slide) { slide.scale = slide.scale + q[0]; }
};

struct XScale : On<Scale, slide_X> {
  static constexpr QuantityCard quantities[] = {Scale::row("E_XX")};
  static constexpr EffectCard card =
      on({.name = "x_scale", .title = "Linear positioning error of X", .iso230 = "E_XX",
          .adds = "x.scale += E_XX",
          .confused_with = Scale::confused_with},
         Scale::common(quantities));
};
struct YScale : On<Scale, slide_Y> {
  static constexpr QuantityCard quantities[] = {Scale::row("E_YY")};
  static constexpr EffectCard card =
      on({.name = "y_scale", .title = "Linear positioning error of Y", .iso230 = "E_YY",
          .adds = "y.scale += E_YY",
          .confused_with = Scale::confused_with},
         Scale::common(quantities));
};
struct ZScale : On<Scale, slide_Z> {
  static constexpr QuantityCard quantities[] = {Scale::row("E_ZZ")};
  static constexpr EffectCard card{
      .name = "z_scale",
      .title = "Linear positioning error of Z",
      .stage = Stage::motion,
      .iso230 = "E_ZZ",
      .meaning = "Actual minus commanded position grows in proportion to the commanded Z.",
      .adds = "z.scale += E_ZZ",
      .confused_with = "rod_expansion (exactly collinear if spindle_z minus rod_length is constant)",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-1",
      .quantities = quantities};
};

struct RotaryScale {
  static constexpr QuantityCard quantities[] = {
      {.name = "scale", .unit = "um/m", .si_unit = "1", .limits = {-1e-2, 1e-2},
       .meaning = "positioning error per angle of travel: 1 um/m is 1 urad/rad, 3.6e-3 arcsec per deg",
       .role = Role::amplitude, .typical = {10e-6, 200e-6}},
  };
  static constexpr Common common{
      .stage = Stage::rotary,
      .meaning = "Actual minus commanded angle grows in proportion to the command: a gear ratio or a number of lines "
                 "that the control does not quite know. An axis that carries the workpiece turns it by minus the "
                 "command (sense -1), and its error with it.",
      .source = "engineering knowledge; ISO 230-1",
      .quantities = quantities};
  template <class T> static void add(const T* q, const Turn<T>& turn) {
    turn.error = turn.error + q[0] * (turn.axis.sense * turn.axis.angle);
  }
};

struct BScale : On<RotaryScale, axis_B> {
  static constexpr EffectCard card =
      on({.name = "b_scale", .title = "Linear positioning error of B", .iso230 = "E_BB",
          .adds = "E_BB += B.sense scale B",
          .confused_with = "the sine of b_encoder_eccentricity over a short range of B; E_A0B, E_C0B"},
         RotaryScale::common);
};
struct CScale : On<RotaryScale, axis_C> {
  static constexpr EffectCard card =
      on({.name = "c_scale", .title = "Linear positioning error of C", .iso230 = "E_CC",
          .adds = "E_CC += C.sense scale C",
          .confused_with = "the sine of c_encoder_eccentricity over a short range of C; E_A0C, E_B0C"},
         RotaryScale::common);
};

} // namespace gumshoe::effects
