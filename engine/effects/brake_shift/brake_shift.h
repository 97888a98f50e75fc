#pragma once
#include "effects/part.h"

namespace gumshoe::effects {

struct BrakeShift {
  static constexpr QuantityCard quantities[] = {
      {.name = "angle", .unit = "arcsec", .si_unit = "rad", .limits = {-1e-2, 1e-2},
       .meaning = "rotation of the axis when its brake closes", .role = Role::amplitude,
       .typical = {1 * arcsec, 5 * arcsec}},
  };
  static constexpr Common common{
      .stage = Stage::rotary,
      .meaning = "The brake turns the axis by this angle when it is closed (condition clamped = 1).",
      .source = "engineering knowledge",
      .quantities = quantities};
  template <class T> static void add(const T* q, const Turn<T>& turn) {
    turn.error = turn.error + turn.axis.clamped * q[0];
  }
};

struct BBrakeShift : On<BrakeShift, axis_B> {
  static constexpr EffectCard card =
      on({.name = "b_brake_shift", .title = "Shift of the B axis by its brake", .iso230 = "E_BB",
          .adds = "E_BB += B.clamped angle",
          .confused_with = "b_axis_reversal; any difference between the patterns if the brake closes in only one of "
                           "them"},
         BrakeShift::common);
};
struct CBrakeShift : On<BrakeShift, axis_C> {
  static constexpr EffectCard card =
      on({.name = "c_brake_shift", .title = "Shift of the C axis by its brake", .iso230 = "E_CC",
          .adds = "E_CC += C.clamped angle",
          .confused_with = "c_axis_reversal; any difference between the patterns if the brake closes in only one of "
                           "them"},
         BrakeShift::common);
};

} // namespace gumshoe::effects
