#pragma once
/// One reading of a linear axis against a reference: what it indicates, and what of that is the axis.
#include "models/linear_axis/card.h"
#include "models/reading.h"

namespace gumshoe::models::linear_axis {

struct Rows {
  GUMSHOE_NAMED(Quantities, offset, gain, reference_scale, reference_drift, misalignment, dead_path, wavelength_change,
                expansion, temperature_difference);
  GUMSHOE_NAMED(Conditions, position, direction, time, datum, pitch, reads_position, temperature, pitch_angle,
                compensated);
  GUMSHOE_NAMED(Indications, deviation);
  GUMSHOE_NAMED(Measurands, corrected_deviation);
};
template <class T> using At = Reading<Rows, T>;

/// From the datum to the target, m.
template <class T> T travel(const At<T>& at) { return at.c.position - at.c.datum; }

/// Error of the axis that the freed effects cause, actual minus target, m.
template <class T> T freed_error(const At<T>& at) {
  if (!at.freed.any()) return T(0.0);
  chain::LinearAxis<T> axis;
  axis.travel = travel(at);
  axis.pitch = at.c.pitch;
  axis.temperature = at.c.temperature;
  axis.pitch_angle = at.c.pitch_angle;
  axis.slide.position = at.c.position;
  axis.slide.direction = at.c.direction;
  chain::ProbingEvent<T> event;
  event.time = at.c.time;
  event.axis = &axis;
  at.freed.act(event);
  return axis.slide.error;
}

/// By how much the reference indicates too much, and the axis deviates because it is not at 20 degC, m; to the first
/// order in the errors but for the cosine. A longer wave has fewer fringes on the dead path: the reference, which
/// counts them, then indicates less.
template <class T> T reference_error(const At<T>& at) {
  const auto& q = at.q;
  const T half = num::sin(0.5 * q.misalignment);
  const T share = q.reference_scale - 2.0 * (half * half) + (q.expansion * q.temperature_difference - at.c.compensated);
  return travel(at) * share + q.reference_drift * at.c.time - q.dead_path * q.wavelength_change;
}

/// What is read of an axis without any error, m.
template <class T> T nominal(const At<T>& at) { return at.c.reads_position * at.c.position; }

template <class T> Simulated<Rows, T> simulate(const At<T>& at) {
  const T true_deviation = at.q.offset + at.q.gain * travel(at);
  return {{nominal(at) + (true_deviation + (reference_error(at) + freed_error(at)))}, {true_deviation}};
}
template <class T> Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read) {
  return {read.deviation - nominal(at) - (reference_error(at) + freed_error(at))};
}

} // namespace gumshoe::models::linear_axis
