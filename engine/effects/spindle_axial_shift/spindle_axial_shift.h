#pragma once
#include <numbers>

#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct SpindleAxialShift {
  static constexpr QuantityCard quantities[] = {
      {.name = "at_once", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "immediate shift at 10 000 rpm", .role = Role::amplitude, .typical = {1e-6, 20e-6}},
      {.name = "gradual", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "gradual shift at 10 000 rpm, when warm", .role = Role::amplitude, .typical = {5e-6, 50e-6}},
      {.name = "time_constant", .unit = "min", .si_unit = "s", .default_value = 600.0, .limits = {1.0, 1e6},
       .meaning = "time constant of the gradual shift", .role = Role::shape, .typical = {300, 1800}},
  };
  static constexpr EffectCard card{
      .name = "spindle_axial_shift",
      .title = "Axial shift of a turning spindle",
      .stage = Stage::spindle,
      .meaning = "The spindle nose moves towards -Z by (speed / 10 000 rpm)^2 (at_once + gradual (1 - exp(-time / "
                 "time_constant))), because of centrifugal load and heat in the bearings. Time is counted from the "
                 "start of "
                 "the work, with the spindle turning.",
      .adds = "z.error -= (speed / 10 000 rpm)^2 (at_once + gradual (1 - exp(-time / time_constant)))",
      .confused_with = "thermal_growth; a length error if all indications share one speed",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    constexpr double reference = 10000 * 2 * std::numbers::pi / 60;
    const T ratio = event.turning->speed / reference;
    event.z.error = event.z.error - ratio * ratio * (q[0] + q[1] * (1.0 - num::exp(-(event.time / q[2]))));
  }
};

} // namespace gumshoe::effects
