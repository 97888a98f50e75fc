#pragma once
/// Calibrating a probe and two rotary axes with a sphere: the model. Its physics stands in contact.h, its joint
/// evaluations in procedures.h.
#include "models/sphere_calibration/procedures.h"

namespace gumshoe::models::sphere_calibration {

struct SphereCalibration {
  using Rows = sphere_calibration::Rows;
  static constexpr ModelCard card{
      .name = "sphere_calibration",
      .title = "Calibrating a probe and two rotary axes with a sphere",
      .summary = "A probe on a belt grinder touches the top of a sphere at many angles of B and C; the recorded "
                 "commands give the probe's position and the location errors of both axes.",
      .source = "Fang 2022, chapter 4 (eqs 4.1 to 4.51), derived anew; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages,
      .axes = axis_cards};

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const auto& c = at.c;
    const T zero(0.0), one(1.0);
    if (at.evaluation == closed_form) {
      outcome.refuse(!has_closed_form(c), "closed_form holds only at B = 0 (pattern 1) or at C = 90 deg (pattern 2)");
      if (at.freed.any()) outcome.refuse(one == one, "closed_form cannot include effects");
    }
    outcome.refuse(c.feed < zero, "feed is negative");
    const auto no_side = [&](const T& x) { return (x != one) && (x != -one) && (x != zero); };
    outcome.refuse(no_side(c.B_direction), "B_direction must be 1, -1 or 0");
    outcome.refuse(no_side(c.C_direction), "C_direction must be 1, -1 or 0");
    outcome.refuse((c.B_clamped != one) && (c.B_clamped != zero), "B_clamped must be 0 or 1");
    outcome.refuse((c.C_clamped != one) && (c.C_clamped != zero), "C_clamped must be 0 or 1");
  }

  template <class T> using Memory = KnownLinks<T>;
  template <class T> static Contact<T> contact(const At<T>& at, KnownLinks<T>& known) {
    // A derivative by squareness does not vanish with its value.
    const bool squareness = num::derivative_levels<T> > 0 || has_squareness(at.q);
    return sphere_calibration::contact(at, known.of(at.q), squareness);
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& reading, KnownLinks<T>& known, Outcome<T>&) {
    const auto at = contact(reading, known);
    const auto x = sphere_calibration::simulate(at);
    return {{x.x, x.y, x.z}, {at.tip.x, at.tip.y, at.tip.z}};
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, KnownLinks<T>& known, const Rows::Indications<T>& read,
                                      Outcome<T>&) {
    const auto tip = sphere_calibration::evaluate({read.X, read.Y, read.Z}, contact(at, known));
    return {tip.x, tip.y, tip.z};
  }

  static std::vector<Intermediate> explain(const At<double>& at, const Rows::Indications<double>& read);

  using Joint = std::tuple<Identify, Identify, Identify>;
};

} // namespace gumshoe::models::sphere_calibration
