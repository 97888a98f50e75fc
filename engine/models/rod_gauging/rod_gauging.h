#pragma once
/// Gauging the height of a laser tool setter's beam with a measuring rod.
///
/// The spindle lowers the rod until its shadow covers a given fraction of the beam; the control latches
/// the spindle height Z'_s. With the rod's length L_r and the height Z'_d of its bottom's centre above
/// the beam's axis at that moment, the axis lies at laser_z = Z'_s - L_r - Z'_d.
/// Source: Fang 2022, chapter 2 (eq 2.38), solved anew: shadow/shadow.h.
#include "models/model.h"
#include "models/reading.h"
#include "models/rod_gauging/card.h"
#include "models/rod_gauging/shadow/trigger_height.h"

namespace gumshoe::models::rod_gauging {

/// The names of the card's rows.
struct Rows {
  GUMSHOE_NAMED(Quantities, rod_radius, fillet_radius, bottom_elevation, bottom_azimuth, rod_length, holder_angle,
                beam_yaw, beam_pitch, beam_radius, trigger_fraction, laser_z);
  GUMSHOE_NAMED(Conditions, feed, time, direction);
  GUMSHOE_NAMED(Indications, spindle_z);
  GUMSHOE_NAMED(Measurands, bottom_height, laser_z);
};
template <class T> using At = Reading<Rows, T>;

/// The event as commanded, with all freed effects applied.
template <class T> chain::ProbingEvent<T> probing_event(const At<T>& at) {
  chain::ProbingEvent<T> event;
  laser_setter::act(at, at.q.rod_length, event);
  return event;
}

/// The rod as it stands in the event.
template <class T> Rod<T> rod(const Rows::Quantities<T>& q, const chain::ProbingEvent<T>& event) {
  return {q.rod_radius, q.fillet_radius, q.bottom_elevation, q.bottom_azimuth + q.holder_angle,
          event.tool_x, event.tool_y};
}

struct RodGauging {
  using Rows = rod_gauging::Rows;
  static constexpr ModelCard card{
      .name = "rod_gauging",
      .title = "Gauging a laser tool setter with a measuring rod",
      .summary =
          "A rod in the spindle is lowered into a laser beam; the trigger fires when its shadow covers a given "
          "fraction of the beam; the spindle height at that moment gives the height of the beam's axis.",
      .source = "Fang 2022, chapter 2 (eqs 2.3 to 2.38), derived anew; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = laser_setter::indications,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages,
      .timing = timing_cards};

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const T zero(0.0), one(1.0), way = at.c.direction;
    outcome.refuse(at.c.feed < zero, "feed is negative");
    outcome.refuse((way != one) && (way != -one) && (way != zero), "direction must be 1, -1 or 0");
  }

  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    outcome.refuse(at.q.fillet_radius > at.q.rod_radius, "fillet_radius exceeds rod_radius");
  }

  /// bottom_height; the conventional evaluation assumes that it is zero.
  template <class T> using Solution = T;
  static constexpr std::string_view solve_ignores[] = {"rod_length", "laser_z"};
  template <class T> static T solve(const At<T>& at, Outcome<T>& outcome) {
    if (!at.simulating && at.evaluation == conventional) return T(0.0);
    return trigger_height(rod(at.q, probing_event(at)), laser_setter::beam(at.q), outcome);
  }

  /// Indication of the control if the beam's axis is at q.laser_z.
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, const T& bottom_height, Outcome<T>&) {
    const auto event = probing_event(at);
    const T actual = at.q.laser_z + at.q.rod_length + event.tool_growth + bottom_height;
    return {{chain::reading_of(actual, event)}, {bottom_height, at.q.laser_z}};
  }

  /// Height of the beam's axis from the reading.
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const T& bottom_height, const Rows::Indications<T>& read,
                                      Outcome<T>&) {
    const auto event = probing_event(at);
    const T actual = chain::actual_of(read.spindle_z, event);
    return {bottom_height, actual - (at.q.rod_length + event.tool_growth) - bottom_height};
  }

  static std::vector<Intermediate> explain(const At<double>& at, const Rows::Indications<double>& read);
};

} // namespace gumshoe::models::rod_gauging
