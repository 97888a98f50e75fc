#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Thermal expansion of the rod or tool. It is longer than at 20 degC (ISO 1): length times coefficient times
/// temperature difference.
struct RodExpansion {
  static constexpr QuantityCard quantities[] = {
      {"coefficient",
       "um/m/K",
       "1/K",
       11.5e-6,
       {-1e-4, 1e-4},
       "alpha_s",
       "coefficient of linear thermal expansion",
       Role::shape,
       "11.5 um/(m K) for steel, 0.5 to 24"},
      {"temperature_difference",
       "K",
       "K",
       0.0,
       {-200.0, 200.0},
       "dT",
       "temperature of the rod or tool minus 20 degC",
       Role::amplitude,
       "0.5-10 K: 1.8 um/K at 160 mm"},
  };
  static constexpr EffectCard card{
      "rod_expansion",
      "Thermal expansion of the rod or tool",
      "pose",
      30,
      "",
      "The rod or tool is longer than at 20 degC (ISO 1): length times coefficient times temperature difference.",
      "z_scale (exactly collinear where spindle_z minus rod_length is constant), drift in time",
      "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; coefficient of steel 11.5 um/(m K)",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_growth = event.tool_growth + event.tool_length * q[0] * q[1];
  }
};

} // namespace gumshoe::effects
