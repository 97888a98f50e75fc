#pragma once
/// Block loops of a model (adapter.h), compiled once per instruction set.
#include <optional>

#include "models/adapter.h"
#include "models/ahead.h"

namespace gumshoe::models::detail {

/// Doubles, or lanes.
template <class M> struct ScalarOf { using type = Lanes; };
template <class M>
requires(M::scalar) struct ScalarOf<M> {
  using type = double;
};

/// Writes values of the samples from i on to consecutive rows, NaN where a sample failed, and the statuses.
template <class T, class Values>
void store(const Values& values, std::size_t rows, double* const* to, std::size_t i, const Outcome<T>& outcome) {
  for (std::size_t m = 0; m < rows; ++m) store_at(reinterpret_cast<const T*>(&values)[m], to[m] + i);
  if (!outcome.failed) return;
  for (std::size_t l = 0; l < numbers_in<T>; ++l)
    if (outcome.status[l] != Status::ok)
      for (std::size_t m = 0; m < rows; ++m) to[m][i + l] = std::nan("");
}
template <class T> void store_status(const BlockCall& call, std::size_t i, const Outcome<T>& outcome) {
  if (!outcome.failed) return;
  for (std::size_t l = 0; l < numbers_in<T>; ++l)
    if (outcome.status[l] != Status::ok) call.status[i + l] = code(outcome.status[l]);
}

/// One reading at a time. `Values compute(at, solution, memory, r, i, outcome)` of what is possible, then
/// `finish(...)`.
template <class M, bool simulating> void run_single(const BlockCall& call) {
  using Rows = typename M::Rows;
  using T = typename ScalarOf<M>::type;
  constexpr std::size_t shown = rows_of<Rows::template Indications>, stated = rows_of<Rows::template Measurands>;
  Group<M, T> group(call, simulating);
  Refusals<M, T> refusals(call, group.quantities());
  typename MemoryOf<M, T>::type memory{};
  std::vector<typename SolutionOf<M, T>::type> solutions(call.readings);
  Reading<Rows, T> at;
  for (std::size_t i = 0; i < call.samples; i += numbers_in<T>) {
    refusals.pass(i);
    for (std::size_t r = 0; r < call.readings; ++r) {
      group.turn(r, i, at);
      Outcome<T> outcome;
      refusals.check(r, at, outcome);
      const bool possible = numbers_in<T> > 1 || !outcome.failed; // a lane that is not takes nothing from the others
      if (possible) solutions[r] = call.solved_as[r] == r ? solve<M>(at, outcome) : solutions[call.solved_as[r]];
      double* const* measurands = call.measurands + r * stated;
      if constexpr (simulating) {
        using Shown = decltype(simulate<M>(at, solutions[r], memory, outcome));
        const Shown x = possible ? simulate<M>(at, solutions[r], memory, outcome) : Shown{};
        store(x.indications, shown, call.simulated + r * shown, i, outcome);
        store(x.measurands, stated, measurands, i, outcome);
      } else {
        using Found = decltype(evaluate<M>(at, solutions[r], memory, group.read(r, i), outcome));
        const Found y = possible ? evaluate<M>(at, solutions[r], memory, group.read(r, i), outcome) : Found{};
        store(y, stated, measurands, i, outcome);
      }
      store_status(call, i, outcome);
    }
  }
}

/// The same for a model that prepares.
template <class M, bool simulating> void run_prepared(const BlockCall& call) {
  using Rows = typename M::Rows;
  constexpr std::size_t shown = rows_of<Rows::template Indications>, stated = rows_of<Rows::template Measurands>;
  typename MemoryOf<M, double>::type memory{};
  Ahead<M> ahead(call, simulating);
  for (std::size_t i = 0; i < call.samples; ++i) {
    ahead.turn(i, memory);
    const auto& all = ahead.readings();
    for (std::size_t r = 0; r < call.readings; ++r) {
      const auto& at = all.at[r];
      Outcome<double> outcome = ahead.outcome(r);
      double* const* measurands = call.measurands + r * stated;
      if constexpr (simulating) {
        using Shown = decltype(M::simulate(at, ahead.prepared(r), outcome));
        const Shown x = outcome.failed ? Shown{} : M::simulate(at, ahead.prepared(r), outcome);
        store(x.indications, shown, call.simulated + r * shown, i, outcome);
        store(x.measurands, stated, measurands, i, outcome);
      } else {
        using Found = decltype(M::evaluate(at, ahead.prepared(r), all.read[r], outcome));
        store(outcome.failed ? Found{} : M::evaluate(at, ahead.prepared(r), all.read[r], outcome), stated, measurands,
              i, outcome);
      }
      store_status(call, i, outcome);
    }
  }
}

/// All readings of a sample together.
template <class M, bool simulating> void run_together(const BlockCall& call) {
  using Rows = typename M::Rows;
  using T = typename ScalarOf<M>::type;
  constexpr std::size_t shown = rows_of<Rows::template Indications>;
  constexpr bool prepares = simulating && Prepares<M>;
  with_joint<M>(call.evaluation, [&]<class J>() {
    typename MemoryOf<M, T>::type memory{};
    auto readings = [&] {
      if constexpr (prepares)
        return Ahead<M>(call, simulating);
      else
        return Present<M, T>(call, simulating);
    }();
    std::optional<typename J::template Memory<T>> together;
    if constexpr (!simulating) together.emplace(first_sample<M>(call));
    using Shown = decltype(simulate<M>(readings.readings().at[0], Nothing{}, memory, std::declval<Outcome<T>&>()));
    std::vector<Shown> truth(simulating ? call.readings : 0);
    for (std::size_t i = 0; i < call.samples; i += numbers_in<T>) {
      readings.turn(i, memory);
      const Together<Rows, T>& all = readings.readings();
      Outcome<T> outcome;
      for (std::size_t l = 0; l < numbers_in<T>; ++l) outcome.fail(l, static_cast<Status>(call.status[i + l]));
      for (std::size_t r = 0; r < call.readings; ++r) {
        readings.check(r, outcome);
        if constexpr (simulating) {
          if (numbers_in < T >> 1 || !outcome.failed) {
            if constexpr (prepares)
              truth[r] = M::simulate(all.at[r], readings.prepared(r), outcome);
            else
              truth[r] = simulate<M>(all.at[r], Nothing{}, memory, outcome);
          }
          store(truth[r].indications, shown, call.simulated + r * shown, i, outcome);
        }
      }
      typename J::template Measurands<T> found{};
      if (numbers_in < T >> 1 || !outcome.failed) {
        if constexpr (simulating)
          found = J::truth(all, truth, outcome);
        else
          found = J::evaluate(all, *together, outcome);
      }
      double quantities[rows_of<Rows::template Quantities>];
      for (std::size_t j = 0; j < std::size(quantities); ++j) quantities[j] = load<double>(call.quantities[j], i);
      store(found, measurands_in_use<M>(call.evaluation, quantities), call.measurands, i, outcome);
      store_status(call, i, outcome);
    }
  });
}

template <class M, bool simulating> void run(const BlockCall& call) {
  if constexpr (HasJoint<M>)
    if (is_joint<M>(call.evaluation)) return run_together<M, simulating>(call);
  if constexpr (Prepares<M>)
    run_prepared<M, simulating>(call);
  else
    run_single<M, simulating>(call);
}

} // namespace gumshoe::models::detail

/// Defines the kernels of the struct TYPE of namespace gumshoe::models::FOLDER for this instruction set.
#define GUMSHOE_MODEL_KERNELS(folder, type)                                                                            \
  extern "C" {                                                                                                         \
  extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_##folder##_);                                           \
  const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_##folder##_){                                                  \
      &gumshoe::models::detail::run<gumshoe::models::folder::type, true>,                                              \
      &gumshoe::models::detail::run<gumshoe::models::folder::type, false>};                                            \
  }
