#pragma once
/// One reading of a turning mill in the beam: its event, its flutes, its true motion, its trigger.
#include <cmath>

#include "models/model.h"
#include "models/reading.h"
#include "models/tool_length/card.h"
#include "models/tool_length/trigger/lagging_feed.h"
#include "models/tool_length/trigger/latch.h"
#include "models/tool_length/trigger/run_out.h"

namespace gumshoe::models::tool_length {

/// The names of the card's rows.
struct Rows {
  GUMSHOE_NAMED(Quantities, tool_radius, insert_radius, insert_thickness, clearance_angle, insert_radial_angle,
                insert_axial_angle, inserts, wear_1, wear_2, wear_3, wear_4, wear_5, wear_6, wear_7, wear_8, wear_9,
                wear_10, wear_11, wear_12, holder_angle, tool_length, offset, beam_yaw, beam_pitch, beam_radius,
                trigger_fraction, laser_z);
  GUMSHOE_NAMED(Conditions, spindle_speed, feed, start_angle, start_height, time, direction);
  GUMSHOE_NAMED(Indications, spindle_z);
  GUMSHOE_NAMED(Measurands, trigger_height, tool_length, effective_length);
};
template <class T> using Quantities = Rows::Quantities<T>;
template <class T> using At = Reading<Rows, T>;

/// Flutes are counted from 0.
template <class T> const T& wear(const Quantities<T>& q, int flute) {
  return array_of(q)[static_cast<int>(Rows::QuantitiesRow::wear_1) + flute];
}
/// Number of flutes; `inserts` must be whole (check_together).
template <class T> int flutes(const Quantities<T>& q) { return static_cast<int>(num::value(q.inserts)); }

/// One reading as the stages of the measuring chain see it, including the part of the tool.
template <class T> struct Event : chain::ProbingEvent<T> { chain::TurningTool<T> tool; };

/// The event as commanded, with all freed effects applied.
template <class T> Event<T> probing_event(const At<T>& at) {
  Event<T> event;
  event.tool.speed = at.c.spindle_speed;
  event.turning = &event.tool;
  laser_setter::act<T>(at, at.q.tool_length, event);
  event.turning = nullptr; // the event may be copied
  return event;
}

/// The insert that all flutes share, before their deviations.
template <class T> Insert<T> insert(const Quantities<T>& q, const chain::ProbingEvent<T>& event) {
  return {q.tool_radius,         q.insert_radius,      q.insert_thickness, q.clearance_angle,
          q.insert_radial_angle, q.insert_axial_angle, event.tool_x,       event.tool_y - q.offset};
}
/// Flute k with its wear and the event's deviations.
template <class T> Flute<T> flute(const Quantities<T>& q, const Event<T>& event, int k) {
  return deviating<T>({insert(q, event), T(2 * pi * k / num::value(q.inserts)), wear(q, k)}, event.tool, k);
}

/// The true motion. The control commands the spindle height at which, according to the quantities, the tool's centre is
/// start_height above the beam. An effect that moves the tool's centre therefore also moves it at the start and changes
/// the phase.
template <class T> InsertMotionOf<T> motion(const At<T>& at, const Event<T>& event) {
  const auto& [q, c] = std::tie(at.q, at.c);
  const T commanded = q.laser_z + q.tool_length + c.start_height;
  return {q.holder_angle + c.start_angle + event.tool.turns_before_feed,
          c.start_height + (event.z.scale * commanded + event.z.error - event.tool_growth),
          c.feed * (1.0 + event.z.scale) / event.tool.speed, event.tool.servo_lag * event.tool.speed};
}
template <class T> bool finite(const InsertMotionOf<T>& m) {
  return std::isfinite(num::value(m.angle) + num::value(m.height) + num::value(m.drop));
}

/// Refuses impossible combinations of quantities and effects: with effects, values may leave the limits of the card.
template <class T> void check_together(const At<T>& at, Outcome<T>& outcome) {
  const auto& q = at.q;
  const double n = num::value(q.inserts);
  outcome.refuse(n != std::floor(n), "inserts is not an integer");
  if (outcome.failed) return;
  const Event<T> event = probing_event(at);
  const double flank = num::value(q.insert_thickness) * std::tan(num::value(q.clearance_angle)); // of every flute
  for (int k = 0; k < flutes(q); ++k) {
    const auto f = converted<double>(flute(q, event, k));
    const auto& i = f.insert;
    outcome.refuse(!tool_radius.limits.contain(i.tool_radius), "tool_radius including its errors is not positive");
    outcome.refuse(!insert_radius.limits.contain(i.radius), "insert_radius including its errors is not positive");
    outcome.refuse(!(flank < i.radius),
                   "insert_thickness times tan(clearance_angle) is not below insert_radius: the flank would end in a "
                   "point");
    outcome.refuse(!insert_axial_angle.limits.contain(i.axial_angle), "insert_axial_angle including its errors is not "
                                                                      "below 90 deg");
    outcome.refuse(!(std::fabs(num::value(wear(q, k))) < i.radius),
                   "wear_1 to wear_n: a wear is not below insert_radius");
  }
  const chain::TurningTool<T>& tool = event.tool;
  const T zero(0.0);
  outcome.refuse(!(tool.speed > zero), "spindle_speed including its error is not positive");
  outcome.refuse(!(event.z.scale > T(-1.0)));
  outcome.refuse(!(tool.servo_lag >= zero));
  outcome.refuse(!(tool.sampling_period >= zero));
  // Whole in a receiver; between whole numbers for fits.
  outcome.refuse(!(tool.confirmations >= zero));
  outcome.refuse(!finite(motion(at, event)), "a quantity of an effect is not finite");
}

/// The height of the unworn tool's centre above the beam's axis at the first trigger.
template <class T> struct Trigger {
  Solved<T> height{T(0.0)};
  int insert = 0;
  T turned = T(0.0); ///< rad, from the feed's begin
};
/// The flutes of a reading as plain numbers; returns how many.
template <class T> std::size_t plain_flutes(const At<T>& at, const Event<T>& event, Flute<double>* all) {
  const auto n = static_cast<std::size_t>(flutes(at.q));
  for (std::size_t k = 0; k < n; ++k) all[k] = converted<double>(flute(at.q, event, static_cast<int>(k)));
  return n;
}
/// The trigger that was solved. Completes the event's latch delay by what depends on it.
template <class T>
Trigger<T> trigger_of(const At<T>& at, Event<T>& event, const InsertMotionOf<T>& m, const InsertTrigger& solved) {
  Trigger<T> result;
  result.height.value = T(std::nan(""));
  result.height.status = solved.status;
  result.insert = solved.insert;
  if (solved.status != Status::ok) return result;
  result.turned = T(solved.turned);
  if constexpr (num::derivative_levels < T >> 0)
    result.turned = differentiable_turned<T>(flute(at.q, event, solved.insert), laser_setter::beam(at.q), m, solved);
  result.height.value = m.height_at(result.turned);
  event.latch_delay = delay_of_latch<T>(event.tool, event.latch_delay, &result.turned);
  return result;
}
template <class T> Trigger<T> trigger(TriggerSolver& solver, const At<T>& at, Event<T>& event) {
  const auto m = motion(at, event);
  if (!finite(m)) return trigger_of<T>(at, event, m, {.status = Status::out_of_domain});
  Flute<double> all[chain::most_inserts];
  const std::size_t n = plain_flutes(at, event, all);
  return trigger_of<T>(at, event, m,
                       lagging_trigger(solver, {all, n}, converted<double>(laser_setter::beam(at.q)),
                                       {num::value(m.angle), num::value(m.height), num::value(m.drop)},
                                       num::value(m.lag)));
}

/// A reading with all that belongs to it.
template <class T> struct Readout {
  Event<T> event;
  Trigger<T> trigger;
  T least_raise = T(0.0); ///< difference in length between the unworn tool and its longest flute
  T spindle_z = T(0.0), length = T(0.0);
  T effective_length = T(0.0); ///< of the longest flute
};

/// Difference in length between the unworn tool and its longest flute.
template <class T> T least_raise(const Quantities<T>& q, const Event<T>& event) {
  T least = flute(q, event, 0).raise;
  for (int k = 1; k < flutes(q); ++k)
    if (const T raise = flute(q, event, k).raise; raise < least) least = raise;
  return least;
}

/// The event where the trigger is not solved.
template <class T> Event<T> event_without_trigger(const At<T>& at) {
  Event<T> event = probing_event(at);
  event.latch_delay = delay_of_latch<T>(event.tool, event.latch_delay, nullptr);
  return event;
}

/// The trigger at given values, or none if its height is assumed to be zero.
template <class T> Readout<T> readout_at(TriggerSolver& solver, const At<T>& at, bool with_solve) {
  Readout<T> o{with_solve ? probing_event(at) : event_without_trigger(at), {}};
  if (with_solve) o.trigger = trigger(solver, at, o.event);
  o.least_raise = least_raise(at.q, o.event);
  return o;
}

/// The machine: indication of the control for a tool of length q.tool_length, with the trigger there.
template <class T> void simulate(Readout<T>& o, const At<T>& at) {
  o.spindle_z =
      chain::reading_of<T>(at.q.laser_z + at.q.tool_length + o.event.tool_growth + o.trigger.height.value, o.event);
  o.length = at.q.tool_length;
  o.effective_length = o.length - o.least_raise;
}
template <class T> Readout<T> simulate(TriggerSolver& solver, const At<T>& at) {
  Readout<T> o = readout_at(solver, at, true);
  simulate(o, at);
  return o;
}

/// The reading for a tool as long as the reading z says without a trigger's height: where evaluation begins.
template <class T> At<T> as_read(At<T> at, const T& z) {
  at.q.tool_length = z - at.q.laser_z;
  return at;
}
/// The measurement model: the tool's length from the reading z; the inverse of simulate. Effects that grow with the
/// length use the resulting length, found by iteration; an expansion of 1e-4 gains four digits per pass. `at` is
/// as_read, and `o` the readout there.
template <class T> Readout<T> evaluate(TriggerSolver& solver, At<T> at, const T& z, Readout<T> o) {
  for (int pass = 0, settled = 0; pass < 20; ++pass) {
    if (pass > 0) o = readout_at(solver, at, at.evaluation == full);
    o.length = chain::actual_of<T>(z, o.event) - at.q.laser_z - o.event.tool_growth - o.trigger.height.value;
    if (!at.freed.any() || o.trigger.height.status != Status::ok) break;
    const double height = num::value(motion(at, o.event).height);
    at.q.tool_length = o.length;
    const Event<T> next = event_without_trigger(at);
    const bool same = num::value(next.tool_growth) == num::value(o.event.tool_growth) &&
                      num::value(motion(at, next).height) == height;
    settled = same ? settled + 1 : 0;
    if (settled > 3 * std::min(1, num::derivative_levels<T>)) break; // derivatives follow the values
  }
  o.spindle_z = z;
  o.effective_length = o.length - o.least_raise;
  return o;
}
template <class T> Readout<T> evaluate(TriggerSolver& solver, const At<T>& at, const T& z) {
  const At<T> read = as_read(at, z);
  return evaluate(solver, read, z, readout_at(solver, read, at.evaluation == full));
}

} // namespace gumshoe::models::tool_length
