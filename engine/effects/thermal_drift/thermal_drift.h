#pragma once
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Thermal drift of the probe against the workpiece along X and Y; along Z it is thermal_growth.
struct ThermalDrift {
  static constexpr QuantityCard quantities[] = {
      {"rate_x", "um/h", "m/s", 0.0, {-1e-6, 1e-6}, "", "steady drift along X", Role::pair, "2-30 um/h"},
      {"rate_y", "um/h", "m/s", 0.0, {-1e-6, 1e-6}, "", "steady drift along Y", Role::pair, "2-30 um/h"},
      {"amplitude_x",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "final drift of the first-order part along X",
       Role::pair,
       "5-50 um"},
      {"amplitude_y",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "final drift of the first-order part along Y",
       Role::pair,
       "5-50 um"},
      {"time_constant", "min", "s", 1800.0, {1.0, 1e6}, "", "of the first-order part", Role::shape, "10-60 min"},
  };
  static constexpr EffectCard card{
      "thermal_drift",
      "Thermal drift along X and Y",
      "slides",
      10,
      "",
      "The probe moves against the workpiece along X and Y with time: rate times time, plus a first-order rise "
      "amplitude (1 - exp(-time / time_constant)). Along Z: thermal_growth.",
      "the angle that is stepped in the order of time; drift of the sphere's holder",
      "engineering knowledge; ISO 230-3",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    const T rise = 1.0 - num::exp(-(event.time / q[4]));
    r.X.error = r.X.error + (q[0] * event.time + q[2] * rise);
    r.Y.error = r.Y.error + (q[1] * event.time + q[3] * rise);
  }
};

} // namespace gumshoe::effects
