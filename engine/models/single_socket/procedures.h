#pragma once
/// Joint evaluations of the single socket method: position errors from all stations of a step, orientation errors from
/// both steps.
#include <array>
#include <string>
#include <vector>

#include "models/block.h"
#include "models/single_socket/station.h"

namespace gumshoe::models::single_socket {

template <class T> using Readings = Together<Rows, T>;

/// Total position error of the machine, true and without the ball's seating.
template <class T> Vector3<T> true_error(const At<T>& at) {
  return {at.q.position_error_x, at.q.position_error_y, at.q.position_error_z};
}
template <class T> Vector3<T> seating(const At<T>& at) { return {at.q.seating_x, at.q.seating_y, at.q.seating_z}; }
template <class T> Body<T> body(const At<T>& at) {
  return turned_ball::body<T>(turn_of(at.evaluation), at.context, at.q, at.c);
}
/// Directions about which the machine turns the ball: X, Y, Z.
template <class T> std::array<bool, 3> turns(const At<T>& at) {
  return chain::turns_about(turn_of(at.evaluation), turned_ball::axes_of(at.context));
}
/// True errors of the angles, of those axes that the machine has.
template <class T> chain::Angles<T> true_angle_errors(const At<T>& at) {
  return chain::only<T>(turns(at), {at.q.d_alpha, at.q.d_beta, at.q.d_gamma});
}

/// The readings of one step, fixed by the conditions, and room for their stations.
template <class T> struct Step {
  std::vector<std::size_t> readings;
  std::vector<Station<T>> stations;
  std::vector<T> changes;

  /// @param number 1 or 2; 0: every reading
  Step(const Readings<double>& all, double number) {
    for (std::size_t r = 0; r < all.size(); ++r)
      if (number == 0 || all.at[r].c.step == number) readings.push_back(r);
  }
  Position<T> position(const Readings<T>& all, Outcome<T>& outcome) {
    stations.clear(), changes.clear();
    for (const std::size_t r : readings) {
      stations.push_back(station(all.at[r]));
      changes.push_back(chain::actual_of(all.read[r].length_change, stations.back().bar));
    }
    const auto p = position_of(stations, changes, is_linear(all.at[0].evaluation));
    const auto arrived = p.last_step < T(1e-9 * si::mm);
    for (std::size_t l = 0; l < numbers_in<T>; ++l)
      if (!holds_at(arrived, l)) outcome.fail(l, Status::not_converged);
    return p;
  }
};
template <class T> T larger(const T& a, const T& b) { return T(0.5) * (a + b + num::abs(a - b)); }

/// What is wrong with the readings of a step; empty if nothing is. @param which "" or "of step 1"
std::string problem_of(const Readings<double>& all, double step);
std::vector<std::string> remarks_on(const Readings<double>& all, double step);

/// position, position_linear
struct Translated {
  struct Names {
    GUMSHOE_NAMED(Measurands, position_error_x, position_error_y, position_error_z, residual_rms, amplification);
  };
  template <class T> using Measurands = Names::Measurands<T>;
  template <class T> struct Memory {
    Step<T> step;
    explicit Memory(const Readings<double>& all) : step(all, 0) {}
  };
  template <class T> static Measurands<T> evaluate(const Readings<T>& all, Memory<T>& m, Outcome<T>& outcome) {
    const auto p = m.step.position(all, outcome);
    const auto d = p.error - seating(all.at[0]);
    return {d.x, d.y, d.z, p.residual_rms, p.amplification};
  }
  template <class T, class Shown>
  static Measurands<T> truth(const Readings<T>& all, const std::vector<Shown>&, Outcome<T>&) {
    const auto d = true_error(all.at[0]);
    return {d.x, d.y, d.z, T(0.0), T(0.0)};
  }
  static std::string check(const Readings<double>& all);
  static std::vector<std::string> remarks(const Readings<double>& all) { return remarks_on(all, 0); }
};

/// Both steps of a machine whose axes turn the ball as `turn` says.
template <Turn turn> struct Rotated {
  template <class T> struct Measurands { std::array<T, std::size(cards<turn>)> value; };
  template <class T> struct Memory {
    Step<T> before, after;
    explicit Memory(const Readings<double>& all) : before(all, 1), after(all, 2) {}
  };
  template <class T>
  static Measurands<T> in_rows(const At<T>& at, const Vector3<T>& before, const Vector3<T>& after,
                               const Found<T>& found, const T& residual, const T& amplification) {
    const auto& [e, c] = std::tie(found.error, found.closure);
    const std::array<T, 10> first{before.x, before.y, before.z, after.x, after.y,
                                  after.z,  c.x,      c.y,      c.z,     found.closure_length};
    if constexpr (turn == Turn::RRTTT) return with(first, e.alpha, e.beta, residual, amplification);
    if constexpr (turn == Turn::TTTRR) return with(first, e.alpha, e.gamma, residual, amplification);
    if constexpr (turn == Turn::RTTTR_head) return with(first, e.beta, residual, amplification);
    if constexpr (turn == Turn::RTTTR_table) return with(first, e.alpha, residual, amplification);
    if constexpr (turn == Turn::described) {
      const auto& axes = *turned_ball::axes_of(at.context);
      return with(first, chain::angle_about(axes.first.direction, e), chain::angle_about(axes.second.direction, e),
                  residual, amplification);
    }
  }

  template <class T> static Measurands<T> evaluate(const Readings<T>& all, Memory<T>& m, Outcome<T>& outcome) {
    const auto one = m.before.position(all, outcome), two = m.after.position(all, outcome);
    const auto& at = all.at[m.after.readings[0]];
    const auto before = one.error - seating(at);
    const auto f = found(body(at), before, two.error, is_linear(at.evaluation));
    const T squares = T(static_cast<double>(m.before.readings.size())) * one.residual_rms * one.residual_rms +
                      T(static_cast<double>(m.after.readings.size())) * two.residual_rms * two.residual_rms;
    const T count(static_cast<double>(m.before.readings.size() + m.after.readings.size()));
    return in_rows(at, before, two.error, f, num::sqrt(squares / count), larger(one.amplification, two.amplification));
  }
  template <class T, class Shown>
  static Measurands<T> truth(const Readings<T>& all, const std::vector<Shown>&, Outcome<T>&) {
    std::size_t r = 0;
    while (r + 1 < all.size() && num::any(all.at[r].c.step != T(2.0))) ++r;
    const auto& at = all.at[r];
    const Found<T> none{true_angle_errors(at), {}, T(0.0)};
    return in_rows(at, true_error(at), after(body(at), true_error(at), none.error), none, T(0.0), T(0.0));
  }
  static std::string check(const Readings<double>& all);
  static std::vector<std::string> remarks(const Readings<double>& all) {
    auto out = remarks_on(all, 1);
    for (const auto& more : remarks_on(all, 2)) out.push_back(more);
    return out;
  }

private:
  template <class T, class... More> static Measurands<T> with(const std::array<T, 10>& first, const More&... more) {
    Measurands<T> y;
    std::copy(first.begin(), first.end(), y.value.begin());
    std::size_t i = first.size();
    ((y.value[i++] = more), ...);
    return y;
  }
};
std::string problem_of_both(const Readings<double>& all);
template <Turn turn> std::string Rotated<turn>::check(const Readings<double>& all) { return problem_of_both(all); }

} // namespace gumshoe::models::single_socket
