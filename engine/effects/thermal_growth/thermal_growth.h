#pragma once
#include "chain/probing_event.h"
#include "chain/warming.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct ThermalGrowth {
  static constexpr QuantityCard quantities[] = {
      {.name = "rate", .unit = "um/h", .si_unit = "m/s", .limits = {-1e-6, 1e-6}, .meaning = "steady growth",
       .role = Role::amplitude, .typical = {1e-6 / 3600, 20e-6 / 3600}},
      {.name = "amplitude", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "final growth of the first-order part", .role = Role::amplitude, .typical = {5e-6, 50e-6}},
      {.name = "time_constant", .unit = "min", .si_unit = "s", .default_value = 1800.0, .limits = {1.0, 1e6},
       .meaning = "time constant of the first-order part", .role = Role::shape, .typical = {600, 3600}},
  };
  static constexpr EffectCard card{
      .name = "thermal_growth",
      .title = "Thermal growth of spindle and Z axis",
      .stage = Stage::motion,
      .meaning = "The spindle nose moves towards -Z with time: rate times time, plus a first-order rise amplitude (1 "
                 "- exp(-time / time_constant)).",
      .adds = "z.error -= rate time + amplitude (1 - exp(-time / time_constant))",
      .confused_with = "order of the rods, rod_expansion, slow changes of the beam",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.z.error = event.z.error - chain::warming(q[0], q[1], q[2], event.time);
  }
};

} // namespace gumshoe::effects
