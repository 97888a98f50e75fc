#pragma once
#include "chain/probing_event.h"
#include "chain/warming.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct DriftRow {
  static constexpr QuantityCard rate(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um/h", .si_unit = "m/s", .limits = {-1e-6, 1e-6}, .meaning = meaning,
            .role = Role::pair, .typical = {2e-6 / 3600, 30e-6 / 3600}};
  }
  static constexpr QuantityCard amplitude(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning,
            .role = Role::pair, .typical = {5e-6, 50e-6}};
  }
};

struct ThermalDrift {
  static constexpr QuantityCard quantities[] = {
      DriftRow::rate("rate_x", "steady drift along X"),
      DriftRow::rate("rate_y", "steady drift along Y"),
      DriftRow::amplitude("amplitude_x", "final drift of the first-order part along X"),
      DriftRow::amplitude("amplitude_y", "final drift of the first-order part along Y"),
      {.name = "time_constant", .unit = "min", .si_unit = "s", .default_value = 1800.0, .limits = {1.0, 1e6},
       .meaning = "time constant of the first-order part", .role = Role::shape, .typical = {600, 3600}},
  };
  static constexpr EffectCard card{
      .name = "thermal_drift",
      .title = "Thermal drift along X and Y",
      .stage = Stage::slides,
      .meaning = "The probe moves against the workpiece along X and Y with time: rate times time, plus a first-order "
                 "rise amplitude (1 - exp(-time / time_constant)). Along Z: thermal_growth.",
      .adds = "x.error += rate_x time + amplitude_x (1 - exp(-time / time_constant)); y.error likewise",
      .confused_with = "the angle that is stepped in the order of time; drift of the sphere's holder",
      .source = "engineering knowledge; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const T rise = chain::first_order_rise(event.time, q[4]);
    event.x.error = event.x.error + (q[0] * event.time + q[2] * rise);
    event.y.error = event.y.error + (q[1] * event.time + q[3] * rise);
  }
};

} // namespace gumshoe::effects
