#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Linear positioning error: actual minus commanded position grows in proportion to the command. Every model with a
/// spindle has Z; X and Y are slides that carry a probe behind rotary axes.
struct Scale {
  static constexpr QuantityCard of(std::string_view symbol) {
    return {symbol,          "um/m",     "1", 0.0, {-1e-2, 1e-2}, symbol, "positioning error per length of travel",
            Role::amplitude, "5-20 um/m"};
  }
  static constexpr EffectCard of_slide(std::string_view name, std::string_view title, int rank, std::string_view symbol,
                                       std::span<const QuantityCard> quantities) {
    return {name,
            title,
            "slides",
            rank,
            symbol,
            "Actual minus commanded position grows in proportion to the command. A model's quantity of this symbol is "
            "an error at one place and adds to the reading.",
            "lengths of the probe and links; the other slides' scales, as all three together are a scale of the whole",
            "engineering knowledge; ISO 230-1",
            quantities};
  }
};

struct XScale {
  static constexpr QuantityCard quantities[] = {Scale::of("E_XX")};
  static constexpr EffectCard card =
      Scale::of_slide("x_scale", "Linear positioning error of X", 20, "E_XX", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.rotary->X.scale = event.rotary->X.scale + q[0];
  }
};

struct YScale {
  static constexpr QuantityCard quantities[] = {Scale::of("E_YY")};
  static constexpr EffectCard card =
      Scale::of_slide("y_scale", "Linear positioning error of Y", 21, "E_YY", quantities);
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.rotary->Y.scale = event.rotary->Y.scale + q[0];
  }
};

struct ZScale {
  static constexpr QuantityCard quantities[] = {Scale::of("E_ZZ")};
  static constexpr EffectCard card{"z_scale",
                                   "Linear positioning error of Z",
                                   "motion",
                                   30,
                                   "E_ZZ",
                                   "Actual minus commanded position grows in proportion to the commanded Z.",
                                   "rod_expansion (exactly collinear where spindle_z minus rod_length is constant)",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-1",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.axis_scale = event.axis_scale + q[0];
  }
};

} // namespace gumshoe::effects
