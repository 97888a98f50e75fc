#pragma once
/// Block loops of a model (adapter.h), compiled once per instruction set.
#include <optional>

#include "models/adapter.h"

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

/// All readings of a sample together.
template <class M, bool simulating> void run_together(const BlockCall& call) {
  using Rows = typename M::Rows;
  using T = typename ScalarOf<M>::type;
  constexpr std::size_t shown = rows_of<Rows::template Indications>;
  with_joint<M>(call.evaluation, [&]<class J>() {
    Group<M, T> group(call, simulating);
    Refusals<M, T> refusals(call, group.quantities());
    typename MemoryOf<M, T>::type memory{};
    std::optional<typename J::template Memory<T>> together;
    if constexpr (!simulating) together.emplace(first_sample<M>(call));
    Together<Rows, T> all;
    using Shown = decltype(simulate<M>(all.at[0], Nothing{}, memory, std::declval<Outcome<T>&>()));
    std::vector<Shown> truth(simulating ? call.readings : 0);
    for (std::size_t i = 0; i < call.samples; i += numbers_in<T>) {
      refusals.pass(i);
      group.together(i, all);
      Outcome<T> outcome;
      for (std::size_t l = 0; l < numbers_in<T>; ++l) outcome.fail(l, static_cast<Status>(call.status[i + l]));
      for (std::size_t r = 0; r < call.readings; ++r) {
        refusals.check(r, all.at[r], outcome);
        if constexpr (simulating) {
          if (numbers_in < T >> 1 || !outcome.failed) truth[r] = simulate<M>(all.at[r], Nothing{}, memory, outcome);
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
