#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Thermal growth of spindle and Z axis. The spindle nose moves towards -Z with time: rate times time, plus a
/// first-order rise amplitude (1 - exp(-time / time_constant)).
struct ThermalGrowth {
  static constexpr QuantityCard quantities[] = {
      {"rate", "um/h", "m/s", 0.0, {-1e-6, 1e-6}, "", "steady growth", Role::amplitude, "1-20 um/h"},
      {"amplitude",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "final growth of the first-order part",
       Role::amplitude,
       "5-50 um"},
      {"time_constant", "min", "s", 1800.0, {1.0, 1e6}, "", "of the first-order part", Role::shape, "10-60 min"},
  };
  static constexpr EffectCard card{"thermal_growth",
                                   "Thermal growth of spindle and Z axis",
                                   "motion",
                                   10,
                                   "",
                                   "The spindle nose moves towards -Z with time: rate times time, plus a first-order "
                                   "rise amplitude (1 - exp(-time / time_constant)).",
                                   "order of the rods, rod_expansion, slow changes of the beam",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-3",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.axis_error = event.axis_error - (q[0] * event.time + q[1] * (1.0 - num::exp(-(event.time / q[2]))));
  }
};

} // namespace gumshoe::effects
