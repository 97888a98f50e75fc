#pragma once
/// Simultaneous trilateration with three laser ball bars: the model. Its physics stands in measurement.h, its joint
/// evaluations in procedures.h.
#include <cmath>

#include "models/laser_ball_bar/procedures.h"

namespace gumshoe::models::laser_ball_bar {

struct LaserBallBar {
  using Rows = laser_ball_bar::Rows;
  static constexpr ModelCard card{
      .name = "laser_ball_bar",
      .title = "Three laser ball bars that measure a tool on its contour",
      .summary = "Three laser ball bars from sockets on the table to one ball at the tool give its position by "
                 "trilateration while the machine follows a contour; its servos' errors are what is measured.",
      .source = "Schmitz and Ziegert 1999; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages,
      .timing = timing_cards,
      .axes = axis_cards};

  static constexpr bool scalar = true;
  using Joint = std::tuple<MachineFrame, SteadyLine, SteadyCircle, Corners>;

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const auto& c = at.c;
    const T zero(0.0), one(1.0), two(2.0);
    const auto neither = [](const T& x, const T& a, const T& b) { return !(x == a) && !(x == b); };
    outcome.refuse(neither(c.contour, one, two) && neither(c.contour, zero, T(3.0)), "contour must be 0, 1, 2 or 3");
    outcome.refuse(neither(c.order, one, two), "order of the servos must be 1 or 2");
    outcome.refuse(neither(c.sense, one, T(-1.0)), "sense must be 1 or -1");
    outcome.refuse(!(c.feed > zero), "feed is not positive");
    outcome.refuse(!(c.size > zero), "size of the contour is not positive");
    outcome.refuse(!(c.acceleration > zero), "acceleration is not positive");
    outcome.refuse(c.jerk < zero, "jerk is negative");
    outcome.refuse(!(c.sides >= T(3.0)) || c.sides > T(12.0) || c.sides != T(std::floor(num::value(c.sides))),
                   "sides must be a whole number from 3 to 12");
    outcome.refuse(c.dwell < zero, "dwell is negative");
    outcome.refuse(!(c.turns > zero) || c.turns > T(1000.0), "turns must be above 0 and at most 1000");
    outcome.refuse(!(c.rise == zero) && (!(c.contour == two) || !(c.elevation == zero)),
                   "rise is not 0, but the contour is no level circle (a helix stands upright)");
    outcome.refuse(c.time < zero, "time is before the start of the contour");
    if (outcome.failed) return;
    const auto contour = contour_of(c);
    if (contour.move())
      outcome.refuse(c.time > T(contour.end() + settled), "time lies more than 1 s after the end of the contour");
  }
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    const auto& q = at.q;
    outcome.refuse(!(sockets(q).y3 > T(0.0)), "the base lengths make no triangle");
    const Vector3<T> across = cross(z_motion(q), x_motion(q));
    outcome.refuse(!(dot(across, across) > T(0.0)), "Z_motion and X_motion have one direction, or none");
  }

  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>& outcome) {
    return laser_ball_bar::simulate(at, outcome);
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>& outcome) {
    return laser_ball_bar::evaluate(at, read, outcome);
  }
  static MadeModel on_machine(const chain::MachineDescription& machine, std::string& why);
  static std::vector<Intermediate> explain(const At<double>& at, const Rows::Indications<double>& read);
};

} // namespace gumshoe::models::laser_ball_bar
