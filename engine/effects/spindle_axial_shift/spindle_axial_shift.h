#pragma once
#include <numbers>

#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Axial shift of a turning spindle, towards -Z: (speed / 10 000 rpm)^2 (at_once + gradual (1 - exp(-time /
/// time_constant))).
struct SpindleAxialShift {
  static constexpr QuantityCard quantities[] = {
      {"at_once",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "at 10 000 rpm, as soon as the spindle turns",
       Role::amplitude,
       "1-20 um"},
      {"gradual", "um", "m", 0.0, {-1e-3, 1e-3}, "", "at 10 000 rpm, when warm", Role::amplitude, "5-50 um"},
      {"time_constant", "min", "s", 600.0, {1.0, 1e6}, "", "of the gradual part", Role::shape, "5-30 min"},
  };
  static constexpr EffectCard card{"spindle_axial_shift",
                                   "Axial shift of a turning spindle",
                                   "spindle",
                                   20,
                                   "",
                                   "The spindle nose moves towards -Z by (speed / 10 000 rpm)^2 (at_once + gradual (1 "
                                   "- exp(-time / time_constant))): bearings under centrifugal load, and their heat. "
                                   "Time counts since the start of the work, with the spindle turning.",
                                   "thermal_growth; a length error while all readouts share one speed",
                                   "engineering knowledge; Fang 2022, chapter 3 for the measurement; ISO 230-3",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    constexpr double reference = 10000 * 2 * std::numbers::pi / 60;
    const T ratio = event.turning->speed / reference;
    event.axis_error = event.axis_error - ratio * ratio * (q[0] + q[1] * (1.0 - num::exp(-(event.time / q[2]))));
  }
};

} // namespace gumshoe::effects
