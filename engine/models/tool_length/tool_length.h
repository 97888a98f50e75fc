#pragma once
/// Length of a round-insert mill, measured turning on a laser tool setter.
///
/// The mill turns and is fed into the beam; the trigger fires when any insert's shadow covers a share of the beam's
/// disc; the control latches the spindle height Z'_s. With the height Z_t of the unworn tool's centre above the laser
/// reference point at that moment, the tool length is L_t = Z'_s - laser_z - Z_t.
/// Source: Fang 2022, chapter 3 (eqs 3.1 to 3.29), solved anew: chain/insert_trigger.h.
#include <cmath>

#include "chain/insert_trigger.h"
#include "chain/probing_event.h"
#include "models/model.h"

namespace gumshoe::models::mill {

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

/// The event as commanded, with all active effects applied.
template <class T>
chain::ProbingEvent<T> probing_event(const T* q, const T* condition, const T* effect_quantities,
                                     std::span<const effects::Active> active) {
  chain::ProbingEvent<T> event;
  event.feed = condition[feed];
  event.time = condition[time];
  event.direction = condition[direction];
  event.holder_angle = q[holder_angle];
  event.tool_length = q[length];
  for (const effects::Active& a : active) effects::functions<T>()[a.effect](effect_quantities + a.first, event);
  return event;
}

template <class T> chain::Insert<T> insert(const T* q, const chain::ProbingEvent<T>& event) {
  return {q[tool_radius],  q[insert_radius], q[insert_thickness], q[clearance],
          q[radial_angle], q[axial_angle],   event.tool_x,        event.tool_y - q[offset]};
}
template <class T> chain::Beam<T> beam(const T* q) { return {q[yaw], q[pitch], q[beam_radius], q[fraction]}; }

/// What is impossible about the values together; null if nothing.
inline const char* impossible(const double* q, const double* condition) {
  const double n = q[inserts];
  if (!(n >= 1 && n <= chain::most_inserts && n == std::floor(n))) return "inserts is not a whole number from 1 to 12";
  if (!(q[insert_radius] > 0 && q[insert_thickness] >= 0 && q[tool_radius] > 0)) return "insert_radius is not positive";
  if (!(q[insert_thickness] * std::tan(q[clearance]) < q[insert_radius]))
    return "insert_thickness times tan(clearance_angle) reaches insert_radius: the flank ends in a point";
  for (int k = 0; k < static_cast<int>(n); ++k)
    if (!(std::fabs(q[wear + k]) < q[insert_radius])) return "wear_1 to wear_n: a wear is not below insert_radius";
  if (!(q[beam_radius] > 0 && q[fraction] > 0 && q[fraction] < 1)) return "trigger_fraction is not between 0 and 1";
  if (!(std::fabs(q[pitch]) < 1.5707)) return "beam_pitch is upright";
  if (!(condition[feed] > 0)) return "feed is not positive: the tool never comes down";
  if (!(condition[speed] > 0))
    return "spindle_speed is not positive: the tool has to turn, counter-clockwise from above";
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(q[i])) return "a quantity is not finite";
  for (int i = 0; i < conditions; ++i)
    if (!std::isfinite(condition[i])) return "a condition is not finite";
  return nullptr;
}

/// Descent per radian of spindle angle.
inline double drop(const double* condition) { return condition[feed] / condition[speed]; }

/// Flute k, from 0.
template <class T> chain::Flute<T> flute(const T* q, const chain::ProbingEvent<T>& event, int k) {
  return {insert(q, event), T(2 * 3.14159265358979323846 * k / num::value(q[inserts])), q[wear + k]};
}

/// The first trigger, derivatives dropped.
template <class T>
chain::InsertTrigger trigger(chain::TriggerSolver& solver, const T* q, const chain::ProbingEvent<T>& event,
                             const double* condition) {
  const auto n = static_cast<std::size_t>(num::value(q[inserts]));
  chain::Flute<double> flutes[chain::most_inserts];
  for (std::size_t k = 0; k < n; ++k) flutes[k] = chain::converted<double>(flute(q, event, static_cast<int>(k)));
  return solver.solve({flutes, n}, chain::converted<double>(beam(q)),
                      {num::value(q[holder_angle]) + condition[start_angle], condition[start_height], drop(condition)});
}

/// The machine: what the control reads when the tool is q[length] long.
template <class T> T simulate(const T* q, const T& trigger_height, const chain::ProbingEvent<T>& event) {
  return chain::reading_of(q[laser_z] + q[length] + event.tool_growth + trigger_height, event);
}

/// The measurement model: the tool's length from the reading; the inverse of simulate.
template <class T>
T evaluate(const T& spindle_z, const T* q, const T& trigger_height, const chain::ProbingEvent<T>& event) {
  return chain::actual_of(spindle_z, event) - q[laser_z] - event.tool_growth - trigger_height;
}

/// The longest flute: the tool's length less the least wear.
template <class T> T effective_length(const T* q, const T& tool_length) {
  T least = q[wear];
  for (int k = 1; k < static_cast<int>(num::value(q[inserts])); ++k)
    if (num::value(q[wear + k]) < num::value(least)) least = q[wear + k];
  return tool_length - least;
}

} // namespace gumshoe::models::mill
