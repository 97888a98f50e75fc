#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct RodExpansion {
  static constexpr QuantityCard quantities[] = {
      {.name = "coefficient", .unit = "um/m/K", .si_unit = "1/K", .default_value = 11.5e-6, .limits = {-1e-4, 1e-4},
       .symbol = "alpha_s", .meaning = "coefficient of linear thermal expansion", .role = Role::shape,
       .typical = {11.5e-6, 11.5e-6, "steel; 0.5 to 24 for other materials"}},
      {.name = "temperature_difference", .unit = "K", .si_unit = "K", .limits = {-200.0, 200.0}, .symbol = "dT",
       .meaning = "temperature of the rod or tool minus 20 degC", .role = Role::amplitude,
       .typical = {0.5, 10, "1.8 um/K at 160 mm"}},
  };
  static constexpr EffectCard card{
      .name = "rod_expansion",
      .title = "Thermal expansion of the rod or tool",
      .stage = Stage::pose,
      .meaning = "The rod or tool is longer than at 20 degC (ISO 1): length times coefficient times temperature "
                 "difference.",
      .adds = "tool_growth += tool_length coefficient temperature_difference",
      .confused_with = "z_scale (exactly collinear if spindle_z minus rod_length is constant); drift in time",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; coefficient of steel 11.5 "
                "um/(m K)",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_growth = event.tool_growth + event.tool_length * q[0] * q[1];
  }
};

} // namespace gumshoe::effects
