#pragma once
#include "chain/scanning.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct StandoffShift {
  static constexpr QuantityCard quantities[] = {
      {.name = "shift", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = "of the indication in this set-up",
       .role = Role::amplitude, .typical = {1e-6, 20e-6}},
  };
  static constexpr EffectCard card{
      .name = "standoff_shift",
      .title = "Standoff of the sensor in its seat",
      .stage = Stage::sensor,
      .meaning = "The sensor was mounted or zeroed anew for this set-up; positive if it shows a surface that is nearer. State its "
                 "standard uncertainty per set-up, since its scatter is what matters.",
      .adds = "error += shift",
      .confused_with = "sensor_zero and e_z; thermal_growth if set-ups follow each other; E_Z0B",
      .source = "engineering knowledge",
      .quantities = quantities,
      .scatters_between_clampings = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.scanning->error = event.scanning->error + q[0];
  }
};

} // namespace gumshoe::effects
