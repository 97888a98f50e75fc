#pragma once
#include "effects/per_rotary_axis.h"

namespace gumshoe::effects {

/// Reversal error of a rotary axis. It lags half the reversal value behind its command on either side.
struct AxisReversal {
  static constexpr QuantityCard quantities[] = {
      {"backlash", "arcsec", "rad", 0.0, {-1e-2, 1e-2}, "B", "reversal value", Role::amplitude, "1-10 arcsec"},
  };
  static constexpr EffectCard common{
      "",
      "",
      "rotary",
      30,
      "",
      "The axis lags half the reversal value behind its command: actual minus commanded is -direction backlash / 2, by "
      "the direction from which the angle was reached.",
      "",
      "engineering knowledge; ISO 230-2 for the reversal value",
      quantities};
  template <class T> static void add(const T* q, const RotaryAxis<T>& axis) {
    axis.error = axis.error - axis.direction * (0.5 * q[0]);
  }
};

struct BAxisReversal : OfB<AxisReversal> {
  static constexpr EffectCard card =
      of_axis(AxisReversal::common, 'B', "b_axis_reversal", "Reversal error of the B axis",
              "E_BB where every angle was reached from one side; time, if the sides were measured one after the other");
};

struct CAxisReversal : OfC<AxisReversal> {
  static constexpr EffectCard card =
      of_axis(AxisReversal::common, 'C', "c_axis_reversal", "Reversal error of the C axis",
              "any constant turn of the probe where every angle was reached from one side; time, if the sides were "
              "measured one after the other");
};

} // namespace gumshoe::effects
