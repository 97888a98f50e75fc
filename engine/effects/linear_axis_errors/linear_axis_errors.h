#pragma once
/// Errors of a linear axis along its travel. The reversal error that is the same everywhere: slide_reversal.
#include "chain/linear_axis.h"
#include "chain/warming.h"
#include "effects/effect.h"
#include "math/dual_order.h"

namespace gumshoe::effects {

inline constexpr std::string_view axis_source = "engineering knowledge; ISO 230-1, ISO 230-2";

struct LinearReversalSlope {
  static constexpr QuantityCard quantities[] = {
      {.name = "slope", .unit = "um/m", .si_unit = "1", .limits = {-1e-2, 1e-2},
       .meaning = "growth of the reversal value with the travel from the datum", .role = Role::amplitude,
       .typical = {1e-6, 10e-6}},
  };
  static constexpr EffectCard card{
      .name = "axis_reversal_slope",
      .title = "Reversal error that grows along the axis",
      .stage = Stage::axis,
      .meaning = "The reversal value grows along the travel: a screw that winds up, or friction that changes. Actual "
                 "minus commanded is -direction slope travel / 2.",
      .adds = "axis.error -= axis.direction slope axis.travel / 2",
      .confused_with = "axis_reversal over a short travel; a table by target and direction",
      .source = axis_source,
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    auto& slide = event.axis->slide;
    slide.error = slide.error - slide.direction * (0.5 * q[0] * event.axis->travel);
  }
};

struct PeriodicRow {
  static constexpr QuantityCard row(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3}, .meaning = meaning, .role = Role::pair,
            .typical = {0.5e-6, 5e-6}};
  }
};

struct LinearPeriodicError {
  static constexpr QuantityCard quantities[] = {
      PeriodicRow::row("cosine", "cosine of the position over the pitch"),
      PeriodicRow::row("sine", "sine of the position over the pitch"),
  };
  static constexpr EffectCard card{
      .name = "axis_periodic_error",
      .title = "Periodic error along the axis",
      .stage = Stage::axis,
      .meaning = "Actual minus commanded position repeats with the pitch of the screw or of the scale, which the "
                 "conditions state; without a pitch there is no such error.",
      .adds = "axis.error += cosine cos(2 pi position / pitch) + sine sin(2 pi position / pitch)",
      .confused_with = "a table by target; gain and offset if targets are spaced by whole pitches",
      .source = axis_source,
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    auto& slide = event.axis->slide;
    const T none(0.0), pitch = event.axis->pitch;
    const auto known = pitch > none;
    const T angle = 2.0 * std::numbers::pi * slide.position / num::select(known, pitch, T(1.0));
    slide.error = slide.error + num::select(known, T(q[0] * num::cos(angle) + q[1] * num::sin(angle)), none);
  }
};

struct LinearDrift {
  static constexpr QuantityCard quantities[] = {
      {.name = "rate", .unit = "um/h", .si_unit = "m/s", .limits = {-1e-6, 1e-6}, .meaning = "steady drift",
       .role = Role::amplitude, .typical = {1e-6 / 3600, 20e-6 / 3600}},
      {.name = "amplitude", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "final drift of the first-order part: growth of a spindle or a screw", .role = Role::amplitude,
       .typical = {5e-6, 50e-6}},
      {.name = "time_constant", .unit = "min", .si_unit = "s", .default_value = 1800.0, .limits = {1.0, 1e6},
       .meaning = "time constant of the first-order part", .role = Role::shape, .typical = {600, 3600}},
  };
  static constexpr EffectCard card{
      .name = "axis_drift",
      .title = "Drift of the axis with time",
      .stage = Stage::axis,
      .meaning = "Actual minus commanded position grows with time alike at every position: rate times time, plus a "
                 "first-order rise amplitude (1 - exp(-time / time_constant)).",
      .adds = "axis.error += rate time + amplitude (1 - exp(-time / time_constant))",
      .confused_with = "reference_drift, exactly; axis_reversal if one side is measured first",
      .source = "engineering knowledge; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    auto& slide = event.axis->slide;
    slide.error = slide.error + chain::warming(q[0], q[1], q[2], event.time);
  }
};

struct LinearScaleDrift {
  static constexpr QuantityCard quantities[] = {
      {.name = "rate", .unit = "um/m/h", .si_unit = "1/s", .limits = {-1e-6, 1e-6},
       .meaning = "growth of the error with time, per travel from the datum", .role = Role::amplitude,
       .typical = {1e-6 / 3600, 20e-6 / 3600}},
  };
  static constexpr EffectCard card{
      .name = "axis_scale_drift",
      .title = "Drift of the axis in proportion to its travel",
      .stage = Stage::axis,
      .meaning = "A scale or a screw that warms evenly with time lengthens: actual minus commanded position grows with "
                 "time and with the travel from the datum.",
      .adds = "axis.error += rate axis.travel time",
      .confused_with = "axis_expansion if the temperature rises evenly; axis_drift over a short travel",
      .source = "engineering knowledge; ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    auto& slide = event.axis->slide;
    slide.error = slide.error + q[0] * event.axis->travel * event.time;
  }
};

struct LinearExpansion {
  static constexpr QuantityCard quantities[] = {
      {.name = "coefficient", .unit = "um/m/K", .si_unit = "1/K", .limits = {-1e-4, 1e-4},
       .meaning = "expansion of the axis' scale for which neither control nor reference compensates",
       .role = Role::amplitude, .typical = {1e-6, 12e-6}},
  };
  static constexpr EffectCard card{
      .name = "axis_expansion",
      .title = "Thermal expansion of the axis' scale",
      .stage = Stage::axis,
      .meaning = "The scale is longer by coefficient times its recorded temperature minus 20 degC, and the axis goes "
                 "that much too far.",
      .adds = "axis.error += coefficient (temperature - 20 degC) axis.travel",
      .confused_with = "gain if the temperature is constant; axis_scale_drift if it rises evenly",
      .source = "engineering knowledge; ISO 1, ISO 230-3",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const auto& axis = *event.axis;
    const T excess = axis.temperature - T(chain::reference_temperature);
    event.axis->slide.error = axis.slide.error + q[0] * excess * axis.travel;
  }
};

struct LinearAbbeError {
  static constexpr QuantityCard quantities[] = {
      {.name = "offset", .unit = "mm", .si_unit = "m", .limits = {-10, 10},
       .meaning = "distance across the axis from where its position is measured inside the machine to where the "
                  "reference measures",
       .role = Role::amplitude, .typical = {10e-3, 500e-3}},
  };
  static constexpr EffectCard card{
      .name = "axis_abbe_error",
      .title = "Abbe error of the axis",
      .stage = Stage::axis,
      .meaning = "The recorded pitch of the axis times the offset between its scale and the line of measurement adds to "
                 "the position.",
      .adds = "axis.error += offset pitch_angle",
      .confused_with = "gain if the pitch grows evenly along the axis; a table by target; nothing without a recorded "
                       "pitch_angle",
      .source = "engineering knowledge; ISO 230-1",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    auto& slide = event.axis->slide;
    slide.error = slide.error + q[0] * event.axis->pitch_angle;
  }
};

} // namespace gumshoe::effects
