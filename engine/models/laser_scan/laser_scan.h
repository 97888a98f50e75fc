#pragma once
/// Scanning a part with a displacement sensor on a five-axis machine: the model. Its physics stands in spot.h, its joint
/// evaluation in profile.h.
#include <type_traits>

#include "models/laser_scan/profile.h"

namespace gumshoe::models::laser_scan {

struct LaserScan {
  using Rows = laser_scan::Rows;
  static constexpr ModelCard card{
      .name = "laser_scan",
      .title = "Scanning a part with a displacement sensor on a five-axis machine",
      .summary =
          "A laser displacement sensor in the spindle scans a part on the rotary table; what it reads depends on the "
          "part's form, on how the part is set up and on the location errors of the machine's axes. No condition "
          "states from which side Z reaches a spot: it counts as lowered to the part, so that z_reversal "
          "leaves the sensor backlash / 2 too high at every spot.",
      .source = "Ibaraki et al. 2018, sections 3 and 4, derived anew; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages,
      .timing = timing_cards,
      .axes = axis_cards};

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const auto& c = at.c;
    const T zero(0.0), one(1.0);
    outcome.refuse(c.radius < zero, "radius is negative");
    outcome.refuse(c.speed < zero, "speed is negative");
    const auto no_side = [&](const T& x) { return (x != one) && (x != -one) && (x != zero); };
    outcome.refuse(no_side(c.direction), "direction must be 1, -1 or 0");
    outcome.refuse(no_side(c.B_direction), "B_direction must be 1, -1 or 0");
    const auto among = [&](const T& x, int first, std::size_t count) {
      auto found = x == T(first);
      for (std::size_t i = 1; i < count; ++i) found = found || (x == T(static_cast<double>(first) + static_cast<double>(i)));
      return found;
    };
    outcome.refuse(!among(c.surface, 0, surfaces), "surface must be 0 (cone), 1 (plane), 2 (cylinder), 3 (sphere) or 4 (torus)");
    outcome.refuse(!among(c.profile, 1, most_profiles), "profile must be a whole number from 1 to 12");
  }
  /// In words, for the user's estimates; samples are refused where they are computed.
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    if constexpr (std::is_same_v<T, double>) spot(at, set_up(at), outcome);
  }

  template <class T> using Memory = KnownSetUp<T>;
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, KnownSetUp<T>& known, Outcome<T>& outcome) {
    const T& form = at.q.form_deviation;
    return {{indication(at, spot(at, known.of(at), outcome), form)}, {form}};
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, KnownSetUp<T>& known, const Rows::Indications<T>& read,
                                      Outcome<T>& outcome) {
    return {form_deviation(at, spot(at, known.of(at), outcome), read.displacement)};
  }

  static std::vector<Intermediate> explain(const At<double>& at, const Rows::Indications<double>& read);
  static MadeModel on_machine(const chain::MachineDescription& machine, std::string& why);

  using Joint = std::tuple<Profile>;
};

} // namespace gumshoe::models::laser_scan
