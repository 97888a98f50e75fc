#pragma once
#include "chain/linear_axis.h"
#include "effects/part.h"

namespace gumshoe::effects {

struct SlideReversal {
  static constexpr QuantityCard quantities[] = {
      {.name = "backlash", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .symbol = "B",
       .meaning = "reversal value", .role = Role::amplitude, .typical = {1e-6, 10e-6}},
  };
  static constexpr Common common(Stage stage) {
    return {.stage = stage,
            .meaning = "The slide lags half the reversal value behind its command on either side: actual minus "
                       "commanded is -direction backlash / 2, by the direction from which the position was reached.",
            .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-2 for the "
                      "reversal value",
            .quantities = quantities};
  }
  template <class T> static void add(const T* q, chain::Slide<T>& slide) {
    slide.error = slide.error - slide.direction * (0.5 * q[0]);
  }
};

struct XReversal : On<SlideReversal, slide_X> {
  static constexpr EffectCard card =
      on({.name = "x_reversal", .title = "Reversal error of X", .adds = "x.error -= x.direction backlash / 2",
          .confused_with = "any constant if X is always reached from one side"},
         SlideReversal::common(Stage::slide_directions));
};
struct YReversal : On<SlideReversal, slide_Y> {
  static constexpr EffectCard card =
      on({.name = "y_reversal", .title = "Reversal error of Y", .adds = "y.error -= y.direction backlash / 2",
          .confused_with = "any constant if Y is always reached from one side"},
         SlideReversal::common(Stage::slide_directions));
};
struct ZReversal : On<SlideReversal, slide_Z> {
  static constexpr EffectCard card =
      on({.name = "z_reversal", .title = "Reversal error of Z", .adds = "z.error -= z.direction backlash / 2",
          .confused_with = "any constant if all approaches are from one side"},
         SlideReversal::common(Stage::motion));
};
struct LinearReversal : On<SlideReversal, measured_axis> {
  static constexpr EffectCard card =
      on({.name = "axis_reversal", .title = "Reversal error of the axis", .adds = "axis.error -= axis.direction backlash / 2",
          .confused_with = "any constant if all targets are reached from one side; drift, if one side is measured first"},
         SlideReversal::common(Stage::axis));
};

} // namespace gumshoe::effects
