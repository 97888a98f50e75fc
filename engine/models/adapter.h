#pragma once
/// Makes a row of the catalogue from one struct, for models that evaluate one reading at a time. README.md, "Adding
/// one", shows a whole model.
///
/// A model M has
///   struct Rows                                              the names of the card's rows (GUMSHOE_NAMED)
///   static constexpr ModelCard card
///   static Simulated<Rows, T> simulate(at, outcome)          the machine, for any scalar T
///   static Measurands<T> evaluate(at, indications, outcome)  the measurement model, for any scalar T
/// with const Reading<Rows, T>& at and Outcome<T>& outcome, and may have
///   static void check(at, outcome)            refuses what is impossible about values together, sample by sample
///   static void check_commanded(at, outcome)  refuses conditions; reads nothing else but the evaluation and which
///                                             effects are freed
///   static std::vector<Intermediate> explain(at, indications)
///   template <class T> using Solution, static Solution<T> solve(at, outcome)
///       the expensive part of a reading. Readings that agree in all that the solve reads share one; simulate and
///       evaluate take it as their second argument, `static constexpr std::string_view solve_ignores[]` names the
///       quantities that it does not read.
///   template <class T> using Memory
///       what simulate and evaluate remember from reading to reading, as their second argument, by reference. It
///       changes no bit.
///   static constexpr bool scalar = true                      blocks run on doubles: the physics branches too much for
///                                                            lanes
///   static MadeModel on_machine(description, why)            Model::on_machine; its row carries a context, at.context
///   static int machine_of(int evaluation)     Model::machine_of
///   using Joint = std::tuple<...>                            its joint evaluations, in the order of the card
/// The card's limits are checked here, for points and for samples: a model states them once, in its card.
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/kernel_choice.h"
#include "models/block.h"

namespace gumshoe::models {

template <class M>
concept Solves = requires {
  typename M::template Solution<double>;
};
template <class M>
concept Remembers = requires {
  typename M::template Memory<double>;
};
template <class M>
concept HasJoint = requires {
  typename M::Joint;
};

struct Nothing {};
template <class M, class T> struct MemoryOf { using type = Nothing; };
template <Remembers M, class T> struct MemoryOf<M, T> { using type = typename M::template Memory<T>; };
template <class M, class T> struct SolutionOf { using type = Nothing; };
template <Solves M, class T> struct SolutionOf<M, T> { using type = typename M::template Solution<T>; };

template <class M, class T>
auto solve(const Reading<typename M::Rows, T>& at, Outcome<T>& outcome) -> typename SolutionOf<M, T>::type {
  if constexpr (Solves<M>) return M::solve(at, outcome);
  return {};
}
/// f(at, what M solved or remembers, if it does, more...)
template <class M, class F, class At, class Solution, class Memory, class... More>
auto given(const F& f, const At& at, const Solution& solution, Memory& memory, More&... more) {
  if constexpr (Solves<M>)
    return f(at, solution, more...);
  else if constexpr (Remembers<M>)
    return f(at, memory, more...);
  else
    return f(at, more...);
}
template <class M, class At, class Solution, class Memory, class Outcome>
auto simulate(const At& at, const Solution& solution, Memory& memory, Outcome& outcome) {
  return given<M>([](auto&... with) { return M::simulate(with...); }, at, solution, memory, outcome);
}
template <class M, class At, class Solution, class Memory, class Read, class Outcome>
auto evaluate(const At& at, const Solution& solution, Memory& memory, const Read& read, Outcome& outcome) {
  return given<M>([](auto&... with) { return M::evaluate(with...); }, at, solution, memory, read, outcome);
}

/// The reading of a point call.
template <class M, class T> Reading<typename M::Rows, T> reading_of(const PointCall<T>& call, bool simulating) {
  using Rows = typename M::Rows;
  Reading<Rows, T> at;
  at.q = named<Rows::template Quantities>(call.quantities);
  for (std::size_t i = 0; i < rows_of<Rows::template Conditions>; ++i) array_of(at.c)[i] = T(call.conditions[i]);
  at.freed = {call.active, call.effects};
  at.context = call.context;
  at.evaluation = call.evaluation;
  at.simulating = simulating;
  return at;
}

/// Refuses all that is impossible about one reading at a point: limits of the card, conditions, values together.
template <class M, class T> void check_all(const Reading<typename M::Rows, T>& at, Outcome<T>& outcome) {
  for (std::size_t i = 0; i < M::card.quantities.size(); ++i)
    outcome.refuse(!M::card.quantities[i].limits.contain(num::value(array_of(at.q)[i])));
  detail::check_commanded<M>(at, outcome);
  if constexpr (requires { M::check(at, outcome); })
    if (!outcome.failed) M::check(at, outcome);
}

namespace detail {

/// `compute(at, solution, memory, outcome)` at a point within all limits; NaN elsewhere.
template <class M, class T, class Compute>
PointOutcome at_point(const PointCall<T>& call, bool simulating, T* out, const Compute& compute) {
  // Not in the thread's own storage, which every thread would pay for, whatever it computes.
  thread_local const auto memory = std::make_unique<typename MemoryOf<M, T>::type>();
  const auto at = reading_of<M>(call, simulating);
  Outcome<T> outcome;
  check_all<M>(at, outcome);
  decltype(compute(at, solve<M>(at, outcome), *memory, outcome)) values{};
  if (!outcome.failed) values = compute(at, solve<M>(at, outcome), *memory, outcome);
  for (std::size_t i = 0; i < sizeof(values) / sizeof(T); ++i)
    out[i] = outcome.failed ? T(std::nan("")) : array_of(values)[i];
  return {code(outcome.status[0]), outcome.kink};
}

template <class M, class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  const auto read = named<M::Rows::template Indications>(call.indications);
  return at_point<M>(call, false, call.measurands,
                     [&](const auto& at, const auto& solution, auto& memory, auto& outcome) {
                       return evaluate<M>(at, solution, memory, read, outcome);
                     });
}
template <class M, class T> PointOutcome simulate_point(const PointCall<T>& call) {
  return at_point<M>(call, true, call.simulated, [](const auto& at, const auto& solution, auto& memory, auto& outcome) {
    return simulate<M>(at, solution, memory, outcome).indications;
  });
}

template <class M> std::vector<Intermediate> explain(const PointCall<double>& call) {
  if constexpr (requires {
                  M::explain(reading_of<M>(call, false), named<M::Rows::template Indications>(call.indications));
                })
    return M::explain(reading_of<M>(call, false), named<M::Rows::template Indications>(call.indications));
  return {};
}

template <class M> std::string check(const PointCall<double>& call) {
  for (std::size_t i = 0; i < M::card.quantities.size(); ++i)
    if (!M::card.quantities[i].limits.contain(call.quantities[i]))
      return fmt::format("{} is outside its limits", M::card.quantities[i].name);
  Outcome<double> outcome;
  check_all<M>(reading_of<M>(call, false), outcome);
  return outcome.why ? outcome.why : "";
}

template <class M> bool solve_reads(std::size_t quantity) {
  if constexpr (requires { M::solve_ignores; })
    for (const std::string_view name : M::solve_ignores)
      if (M::card.quantities[quantity].name == name) return false;
  return true;
}

template <class M> std::size_t measurands_in_use(int evaluation, const double* quantities) {
  std::size_t rows = M::card.evaluations[static_cast<std::size_t>(evaluation)].measurands.size();
  with_joint<M>(evaluation, [&]<class J>() {
    if constexpr (requires { J::in_use(named<M::Rows::template Quantities>(quantities)); })
      rows = J::in_use(named<M::Rows::template Quantities>(quantities));
  });
  return rows;
}
template <class M> std::string check_readings(const BlockCall& call) {
  std::string problem;
  with_joint<M>(call.evaluation, [&]<class J>() { problem = J::check(first_sample<M>(call)); });
  return problem;
}
template <class M> std::vector<std::string> remarks(const BlockCall& call) {
  std::vector<std::string> out;
  with_joint<M>(call.evaluation, [&]<class J>() {
    if constexpr (requires { J::remarks(first_sample<M>(call)); }) out = J::remarks(first_sample<M>(call));
  });
  return out;
}

/// Whether the measurands of every joint evaluation are as many as its card's, and named alike where they have names.
template <class M> constexpr bool joint_rows_match() {
  bool good = true;
  for (std::size_t e = 0; e < M::card.evaluations.size(); ++e)
    if (M::card.evaluations[e].joint())
      with_joint<M>(static_cast<int>(e), [&]<class J>() {
        const auto& cards = M::card.evaluations[e].measurands;
        good &= sizeof(typename J::template Measurands<double>) == cards.size() * sizeof(double);
        if constexpr (requires { J::Names::names; }) good &= names_match(J::Names::names, cards);
      });
  return good;
}

} // namespace detail

/// The catalogue's row of M, whose kernels are `kernels`.
template <class M> constexpr Model row_of(const Kernels* (*kernels)()) {
  using Rows = typename M::Rows;
  static_assert(names_match(Rows::QuantitiesRow::names, M::card.quantities), "Rows and card differ: quantities");
  static_assert(names_match(Rows::ConditionsRow::names, M::card.conditions), "Rows and card differ: conditions");
  static_assert(names_match(Rows::IndicationsRow::names, M::card.indications), "Rows and card differ: indications");
  static_assert(names_match(Rows::MeasurandsRow::names, M::card.measurands), "Rows and card differ: measurands");
  Model row{};
  row.card = &M::card;
  row.kernels = kernels;
  row.evaluate_gradient = &detail::evaluate_point<M, Gradient>;
  row.evaluate_curvature = &detail::evaluate_point<M, Curvature>;
  row.simulate_gradient = &detail::simulate_point<M, Gradient>;
  row.explain = &detail::explain<M>;
  row.check = &detail::check<M>;
  row.solve_reads = &detail::solve_reads<M>;
  if constexpr (requires { &M::on_machine; }) row.on_machine = &M::on_machine;
  if constexpr (requires { &M::machine_of; }) row.machine_of = &M::machine_of;
  if constexpr (HasJoint<M>) {
    static_assert(detail::joint_rows_match<M>(), "a joint evaluation and its card differ in their measurands");
    row.measurands_in_use = &detail::measurands_in_use<M>;
    row.check_readings = &detail::check_readings<M>;
    row.remarks = &detail::remarks<M>;
  }
  return row;
}

} // namespace gumshoe::models

/// Defines gumshoe::models::FOLDER::model, the row of the struct TYPE of that namespace.
#define GUMSHOE_MODEL_ROW(folder, type)                                                                                \
  GUMSHOE_DECLARE_KERNELS(gumshoe::models::Kernels, folder)                                                            \
  namespace gumshoe::models::folder {                                                                                  \
  extern const Model model;                                                                                            \
  constinit const Model model = row_of<type>([] { return GUMSHOE_BEST_KERNELS(folder); });                             \
  }
