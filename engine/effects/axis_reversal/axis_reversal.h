#pragma once
#include "effects/part.h"

namespace gumshoe::effects {

struct AxisReversal {
  static constexpr QuantityCard quantities[] = {
      {.name = "backlash", .unit = "arcsec", .si_unit = "rad", .limits = {-1e-2, 1e-2}, .symbol = "B",
       .meaning = "reversal value", .role = Role::amplitude, .typical = {1 * arcsec, 10 * arcsec}},
  };
  static constexpr Common common{
      .stage = Stage::rotary,
      .meaning = "The axis lags half the reversal value behind its command: actual minus commanded angle is -direction "
                 "backlash / 2, by the direction from which the angle was reached. An axis that carries the workpiece "
                 "turns it by minus the command (sense -1), and its error with it.",
      .source = "engineering knowledge; ISO 230-2 for the reversal value",
      .quantities = quantities};
  template <class T> static void add(const T* q, const Turn<T>& turn) {
    turn.error = turn.error - turn.axis.sense * turn.axis.direction * (0.5 * q[0]);
  }
};

struct BAxisReversal : On<AxisReversal, axis_B> {
  static constexpr EffectCard card =
      on({.name = "b_axis_reversal", .title = "Reversal error of the B axis", .iso230 = "E_BB",
          .adds = "E_BB -= B.sense B.direction backlash / 2",
          .confused_with = "E_BB if every angle was reached from one side; time, if the sides were measured one "
                           "after the other"},
         AxisReversal::common);
};
struct CAxisReversal : On<AxisReversal, axis_C> {
  static constexpr EffectCard card =
      on({.name = "c_axis_reversal", .title = "Reversal error of the C axis", .iso230 = "E_CC",
          .adds = "E_CC -= C.sense C.direction backlash / 2",
          .confused_with = "any constant rotation of the probe if every angle was reached from one side; time, if the "
                           "sides were measured one after the other"},
         AxisReversal::common);
};

} // namespace gumshoe::effects
