#pragma once
#include "effects/per_rotary_axis.h"

namespace gumshoe::effects {

/// The brake turns a rotary axis as it closes.
struct BrakeShift {
  static constexpr QuantityCard quantities[] = {
      {"angle",
       "arcsec",
       "rad",
       0.0,
       {-1e-2, 1e-2},
       "",
       "turn of the axis when its brake holds",
       Role::amplitude,
       "1-5 arcsec"},
  };
  static constexpr EffectCard common{
      "",        "",
      "rotary",  40,
      "",        "The axis is turned by an angle where its brake holds (condition clamped = 1).",
      "",        "engineering knowledge",
      quantities};
  template <class T> static void add(const T* q, const RotaryAxis<T>& axis) {
    axis.error = axis.error + axis.clamped * q[0];
  }
};

struct BBrakeShift : OfB<BrakeShift> {
  static constexpr EffectCard card =
      of_axis(BrakeShift::common, 'B', "b_brake_shift", "Shift of the B axis by its brake",
              "b_axis_reversal; what differs between the patterns if the brake closes in one of them");
};

struct CBrakeShift : OfC<BrakeShift> {
  static constexpr EffectCard card =
      of_axis(BrakeShift::common, 'C', "c_brake_shift", "Shift of the C axis by its brake",
              "c_axis_reversal; what differs between the patterns if the brake closes in one of them");
};

} // namespace gumshoe::effects
