#pragma once
/// Length of a round-insert mill, measured turning on a laser tool setter.
///
/// The mill turns and is fed into the beam; the trigger fires when any insert's shadow covers a share of the beam's
/// disc; the control latches the spindle height Z'_s. With the height Z_t of the unworn tool's centre above the laser
/// reference point at that moment, the tool length is L_t = Z'_s - laser_z - Z_t.
/// Source: Fang 2022, chapter 3 (eqs 3.1 to 3.29), solved anew: trigger/insert_trigger.h.
#include <cmath>

#include "models/tool_length/trigger/lagging_feed.h"
#include "models/tool_length/trigger/latch.h"
#include "models/tool_length/trigger/run_out.h"
#include "effects/act.h"
#include "models/laser_setter.h"

namespace gumshoe::models::tool_length {

enum Quantity {
  tool_radius,
  insert_radius,
  insert_thickness,
  clearance,
  radial_angle,
  axial_angle,
  inserts,
  wear, ///< of the first of twelve
  holder_angle = wear + chain::most_inserts,
  length,
  offset,
  yaw,
  pitch,
  beam_radius,
  fraction,
  laser_z,
  count
};
enum Condition { speed, feed, start_angle, start_height, time, direction, conditions };
enum Measurand { trigger_height_row, length_row, effective_row, measurands };
enum Evaluation { full, conventional, single, slow, characteristic_curve, peaks }; ///< from single on: procedures.h

/// What the stages of the measuring chain, the tool's own included, say of one readout.
template <class T> struct Event : chain::ProbingEvent<T> { chain::TurningTool<T> tool; };

/// The event as commanded, with all active effects applied.
template <class T>
Event<T> probing_event(const T* q, const T* condition, const T* effect_quantities,
                       std::span<const effects::Active> active) {
  Event<T> event;
  event.z.feed = condition[feed];
  event.time = condition[time];
  event.z.direction = condition[direction];
  event.holder_angle = q[holder_angle];
  event.tool_length = q[length];
  event.tool.speed = condition[speed];
  event.turning = &event.tool;
  effects::act(active, effect_quantities, event);
  event.turning = nullptr; // the event may be copied
  return event;
}

template <class T> Insert<T> insert(const T* q, const chain::ProbingEvent<T>& event) {
  return {q[tool_radius],  q[insert_radius], q[insert_thickness], q[clearance],
          q[radial_angle], q[axial_angle],   event.tool_x,        event.tool_y - q[offset]};
}
template <class T> Beam<T> beam(const T* q) { return laser_setter::beam(q + yaw); }

/// Flute k, from 0.
template <class T> Flute<T> flute(const T* q, const Event<T>& event, int k) {
  return deviating<T>({insert(q, event), T(2 * std::numbers::pi * k / num::value(q[inserts])), q[wear + k]}, event.tool,
                             k);
}

/// The true motion. The control commands the spindle height at which, as the quantities say, the tool's centre stands
/// start_height above the beam; what truly moves the tool's centre, then, moves it at the start, too, and turns the
/// phase.
template <class T> InsertMotionOf<T> motion(const T* q, const Event<T>& event, const double* condition) {
  const T commanded = q[laser_z] + q[length] + condition[start_height];
  return {q[holder_angle] + condition[start_angle] + event.tool.turns_before_feed,
          condition[start_height] + (event.z.scale * commanded + event.z.error - event.tool_growth),
          condition[feed] * (1.0 + event.z.scale) / event.tool.speed, event.tool.servo_lag * event.tool.speed};
}

/// What is impossible about the values together, effects included; null if nothing.
template <class T> const char* impossible(const T* q, const double* condition, const Event<T>& event) {
  const auto at = [&](int i) { return num::value(q[i]); };
  const auto whole = [](double x) { return x >= 0 && x == std::floor(x); };
  const double n = at(inserts);
  if (!(n >= 1 && n <= chain::most_inserts && whole(n))) return "inserts is not a whole number from 1 to 12";
  if (!(condition[feed] > 0)) return "feed is not positive: the tool never comes down";
  if (!(condition[speed] > 0))
    return "spindle_speed is not positive: the tool has to turn, counter-clockwise from above";
  if (condition[direction] != -1) return "direction is not -1: a mill is fed downwards";
  for (int i = 0; i < conditions; ++i)
    if (!std::isfinite(condition[i])) return "a condition is not finite";
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(at(i))) return "a quantity is not finite";
  if (!(at(beam_radius) > 0)) return "beam_radius is not positive";
  if (!(at(fraction) > 0 && at(fraction) < 1)) return "trigger_fraction is not between 0 and 1";
  if (!(std::fabs(at(pitch)) < 1.5707)) return "beam_pitch is upright";
  for (int k = 0; k < static_cast<int>(n); ++k) {
    const auto f = converted<double>(flute(q, event, k));
    if (!(f.insert.tool_radius > 0)) return "tool_radius with its errors is not positive";
    if (!(f.insert.radius > 0)) return "insert_radius with its errors is not positive";
    if (!(f.insert.thickness >= 0)) return "insert_thickness is negative";
    if (!(f.insert.thickness * std::tan(f.insert.clearance) < f.insert.radius))
      return "insert_thickness times tan(clearance_angle) reaches insert_radius: the flank ends in a point";
    if (!(std::fabs(f.insert.axial_angle) < 0.5 * std::numbers::pi)) return "insert_axial_angle with its errors is upright";
    if (!(std::fabs(at(wear + k)) < f.insert.radius)) return "wear_1 to wear_n: a wear is not below insert_radius";
  }
  const chain::TurningTool<T>& tool = event.tool;
  if (!(num::value(tool.speed) > 0)) return "spindle_speed with its error is not positive";
  if (!(num::value(event.z.scale) > -1)) return "z_scale turns the axis round";
  if (!(num::value(tool.servo_lag) >= 0)) return "servo_lag.time_constant is negative";
  if (!(num::value(tool.sampling_period) >= 0)) return "sampling_rate.period is negative";
  // Whole in a receiver; between whole numbers for fits.
  if (!(num::value(tool.confirmations) >= 0)) return "revolution_confirm.revolutions is negative";
  const auto m = motion(q, event, condition);
  if (!std::isfinite(num::value(m.angle) + num::value(m.height) + num::value(m.drop)))
    return "a quantity of an effect is not finite";
  return nullptr;
}

/// The height of the unworn tool's centre above the beam's axis at the first trigger. Completes the event's latch delay
/// by what depends on the trigger.
template <class T> struct Trigger {
  Solved<T> height{T(0.0)};
  int insert = 0;
  T turned = T(0.0); ///< rad, from the feed's begin
};
template <class T>
Trigger<T> trigger(TriggerSolver& solver, const T* q, const double* condition, Event<T>& event) {
  Trigger<T> result;
  result.height.value = T(std::nan(""));
  const auto n = static_cast<std::size_t>(num::value(q[inserts]));
  Flute<double> flutes[chain::most_inserts];
  for (std::size_t k = 0; k < n; ++k) flutes[k] = converted<double>(flute(q, event, static_cast<int>(k)));
  const auto m = motion(q, event, condition);
  const auto solved =
      lagging_trigger(solver, {flutes, n}, converted<double>(beam(q)),
                             {num::value(m.angle), num::value(m.height), num::value(m.drop)}, num::value(m.lag));
  result.height.status = solved.status;
  result.insert = solved.insert;
  if (solved.status != Status::ok) return result;
  result.turned = differentiable_turned<T>(flute(q, event, solved.insert), beam(q), m, solved);
  result.height.value = m.height_at(result.turned);
  event.latch_delay = delay_of_latch<T>(event.tool, event.latch_delay, &result.turned);
  return result;
}

template <class T> struct Outcome {
  Event<T> event;
  Trigger<T> trigger;
  T spindle_z = T(0.0), length = T(0.0);
  T effective_length = T(0.0); ///< of the longest flute
};

/// The trigger at given values, or none for an evaluation that takes its height for zero.
template <class T>
Outcome<T> outcome_at(TriggerSolver& solver, const T* q, const PointCall<T>& call, bool with_solve) {
  T condition[conditions];
  for (int i = 0; i < conditions; ++i) condition[i] = T(call.conditions[i]);
  Outcome<T> o{probing_event<T>(q, condition, call.effects, call.active), {}};
  if (impossible(q, call.conditions, o.event))
    o.trigger.height = {T(std::nan("")), Status::out_of_domain};
  else if (with_solve)
    o.trigger = trigger(solver, q, call.conditions, o.event);
  else
    o.event.latch_delay = delay_of_latch<T>(o.event.tool, o.event.latch_delay, nullptr);
  return o;
}

/// How much shorter than the unworn tool its longest flute is.
template <class T> T least_raise(const T* q, const Event<T>& event) {
  if (!(num::value(q[inserts]) >= 1 && num::value(q[inserts]) <= chain::most_inserts)) return T(std::nan(""));
  T least = flute(q, event, 0).raise;
  for (int k = 1; k < static_cast<int>(num::value(q[inserts])); ++k)
    if (const T raise = flute(q, event, k).raise; num::value(raise) < num::value(least)) least = raise;
  return least;
}

/// The machine: what the control reads when the tool is q[length] long.
template <class T> Outcome<T> simulate(TriggerSolver& solver, const PointCall<T>& call) {
  const T* q = call.quantities;
  Outcome<T> o = outcome_at(solver, q, call, true);
  o.spindle_z = chain::reading_of<T>(q[laser_z] + q[length] + o.event.tool_growth + o.trigger.height.value, o.event);
  o.length = q[length];
  o.effective_length = o.length - least_raise(q, o.event);
  return o;
}

/// The measurement model: the tool's length from the reading; the inverse of simulate. Effects that grow with the
/// length do so by the length that comes out, found by repetition; an expansion of 1e-4 gains four digits a pass.
template <class T> Outcome<T> evaluate(TriggerSolver& solver, const PointCall<T>& call) {
  T q[count];
  for (int i = 0; i < count; ++i) q[i] = call.quantities[i];
  const T& z = call.indications[0];
  q[length] = z - q[laser_z];
  Outcome<T> o;
  for (int pass = 0, settled = 0; pass < 20; ++pass) {
    o = outcome_at(solver, q, call, call.evaluation == full);
    o.length = chain::actual_of<T>(z, o.event) - q[laser_z] - o.event.tool_growth - o.trigger.height.value;
    if (call.active.empty() || o.trigger.height.status != Status::ok) break;
    const double height = num::value(motion(q, o.event, call.conditions).height);
    q[length] = o.length;
    const Event<T> next = outcome_at(solver, q, call, false).event;
    const bool same = num::value(next.tool_growth) == num::value(o.event.tool_growth) &&
                      num::value(motion(q, next, call.conditions).height) == height;
    settled = same ? settled + 1 : 0;
    if (settled > 3 * std::min(1, num::derivative_levels<T>)) break; // derivatives follow the values
  }
  o.spindle_z = z;
  o.effective_length = o.length - least_raise(q, o.event);
  return o;
}

} // namespace gumshoe::models::mill
