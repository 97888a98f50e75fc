#pragma once
#include "chain/scanning.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct NonlinearityRow {
  static constexpr QuantityCard row(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning, .role = Role::amplitude,
            .typical = {0.3e-6, 5e-6}};
  }
};

struct SensorNonlinearity {
  static constexpr QuantityCard quantities[] = {NonlinearityRow::row("quadratic", "error at a displacement of 1 mm, second order"),
                                                NonlinearityRow::row("cubic", "error at a displacement of 1 mm, third order")};
  static constexpr EffectCard card{
      .name = "sensor_nonlinearity",
      .title = "Non-linearity of the displacement sensor",
      .stage = Stage::sensor,
      .meaning = "The indication deviates by quadratic d^2 + cubic d^3, d the displacement that the quantities predict, in mm.",
      .adds = "error += quadratic d^2 + cubic d^3 (d: displacement in mm)",
      .confused_with = "sensor_gain over a small range; the cone's slope, if the displacement follows the radius",
      .source = "engineering knowledge: 0.03 to 0.1 % of full scale",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::Scanning<T>& s = *event.scanning;
    const T d = 1000.0 * s.displacement;
    s.error = s.error + d * d * (q[0] + q[1] * d);
  }
};

} // namespace gumshoe::effects
