#pragma once
/// The single socket method with a ball bar: the model. One reading stands in station.h, the turned ball in
/// chain/turned_point.h, the joint evaluations in procedures.h.
#include "models/single_socket/procedures.h"

namespace gumshoe::models::single_socket {

struct SingleSocket {
  using Rows = single_socket::Rows;
  static constexpr ModelCard card{
      .name = "single_socket",
      .title = "Single socket method: position and orientation errors of a five-axis machine with a ball bar",
      .summary =
          "A ball bar between a socket and a ball at three or more stations gives the position errors of a machine "
          "there; the same before and after a rotation gives the orientation errors of its rotary axes.",
      .source = "Wang, Yu, Liao 2013, corrected; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = stages};

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const T zero(0.0), one(1.0), two(2.0);
    const auto& c = at.c;
    outcome.refuse((c.step != one) && (c.step != two), "step must be 1 or 2");
    outcome.refuse((c.direction != one) && (c.direction != -one) && (c.direction != zero),
                   "direction must be 1, -1 or 0");
    if (!is_rotated(at.evaluation)) return; // a position error is one on every machine
    turned_ball::refuse_machine<T>(turn_of(at.evaluation), at.context, outcome);
    turned_ball::refuse_angles<T>(turns(at), {c.alpha, c.beta, c.gamma}, outcome);
  }
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    const T two(2.0);
    const auto s = station(at);
    const T distance = length(s.lever);
    outcome.refuse(distance < T(si::mm), "station and reference are less than 1 mm apart");
    outcome.refuse(num::abs(s.nominal - distance) > T(0.01) * distance,
                   "bar_length differs from the distance between station and reference by more than 1 %");
    if (!is_rotated(at.evaluation)) return;
    turned_ball::check(body(at), at.q, at.c.step == two, outcome);
  }

  /// Position error of the ball at the reading's step, its seating included.
  template <class T> static Vector3<T> error_of_ball(const At<T>& at) {
    const Vector3<T> before = true_error(at) + seating(at);
    if (!is_rotated(at.evaluation)) return before;
    return choose(at.c.step == T(2.0), after(body(at), true_error(at), true_angle_errors(at)), before);
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>&) {
    const auto s = station(at);
    const T change = change_of_length<T>(s, error_of_ball(at) + s.slides);
    return {{chain::reading_of(change, s.bar)}, {change}};
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>&) {
    return {chain::actual_of(read.length_change, station(at).bar)};
  }

  using Joint =
      std::tuple<Translated, Translated, Rotated<Turn::RRTTT>, Rotated<Turn::TTTRR>, Rotated<Turn::RTTTR_head>,
                 Rotated<Turn::RTTTR_table>, Rotated<Turn::RRTTT>, Rotated<Turn::TTTRR>, Rotated<Turn::RTTTR_head>,
                 Rotated<Turn::RTTTR_table>, Rotated<Turn::described>>;
  static MadeModel on_machine(const chain::MachineDescription& machine, std::string& why);
};

} // namespace gumshoe::models::single_socket
