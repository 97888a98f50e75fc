#pragma once
/// The readings of a block call under their names, one group of samples at a time.
#include <algorithm>
#include <vector>

#include "models/columns.h"
#include "models/reading.h"

namespace gumshoe::models {

/// All readings of the samples at hand, for joint evaluations.
template <class Rows, class T> struct Together {
  std::vector<Reading<Rows, T>> at;
  std::vector<typename Rows::template Indications<T>> read; ///< empty while simulating
  std::vector<T> effects;                                   ///< quantities of the freed effects, by reading
  const Declared* declared = nullptr;                       ///< null where nothing is declared: a table
  std::size_t size() const { return at.size(); }
};

namespace detail {

/// Refuses conditions that are not finite, or that M refuses.
template <class M, class T> void check_commanded(const Reading<typename M::Rows, T>& at, Outcome<T>& outcome) {
  for (std::size_t j = 0; j < M::card.conditions.size(); ++j)
    outcome.refuse(!(num::abs(array_of(at.c)[j]) < T(1e300)), "a condition is not finite");
  if constexpr (requires { M::check_commanded(at, outcome); }) M::check_commanded(at, outcome);
}

/// Where x lies within limits: a bool, or a mask of lanes.
template <class T> auto within(const Limits& limits, const T& x) {
  const T low(limits.low), high(limits.high);
  return (limits.low_open ? x > low : x >= low) && (limits.high_open ? x < high : x <= high);
}

/// The readings of a call under their names. @tparam T double, or Lanes
template <class M, class T> class Group {
  using Rows = typename M::Rows;
  static constexpr std::size_t shown = rows_of<Rows::template Indications>;

public:
  using Indications = typename Rows::template Indications<T>;

  Group(const BlockCall& call, bool simulating)
      : call_(call), simulating_(simulating),
        quantities_(call.quantities, call.readings, rows_of<Rows::template Quantities>),
        conditions_(call.conditions, call.readings, rows_of<Rows::template Conditions>),
        effects_(call.effect_quantities) {}

  const Columns& quantities() const { return quantities_; }
  /// Turns the reading before into reading r, of the samples from i on; reading 0 may be made of any. The quantities of
  /// its effects stay until the next call.
  void turn(std::size_t r, std::size_t i, Reading<Rows, T>& x) { turn(r, i, x, effects_.data()); }
  Indications read(std::size_t r, std::size_t i) const {
    Indications x;
    for (std::size_t k = 0; k < shown; ++k) array_of(x)[k] = load<T>(call_.indications[r * shown + k], i);
    return x;
  }
  /// All readings of the samples from i on; `all` is empty, or holds those of other samples.
  void together(std::size_t i, Together<Rows, T>& all) {
    all.declared = call_.declared;
    all.at.resize(call_.readings);
    all.effects.resize(call_.readings * effects_.size());
    for (std::size_t r = 0; r < call_.readings; ++r) {
      if (r > 0) all.at[r] = all.at[r - 1];
      turn(r, i, all.at[r], all.effects.data() + r * effects_.size());
    }
    if (simulating_ || !call_.indications) return;
    all.read.resize(call_.readings);
    for (std::size_t r = 0; r < call_.readings; ++r) all.read[r] = read(r, i);
  }

private:
  void turn(std::size_t r, std::size_t i, Reading<Rows, T>& x, T* effects) const {
    quantities_.load(r, i, array_of(x.q));
    conditions_.load(r, i, array_of(x.c));
    for (std::size_t j = 0; j < effects_.size(); ++j) effects[j] = load<T>(call_.effects[r * effects_.size() + j], i);
    x.freed = {call_.active, effects};
    x.context = call_.context;
    x.evaluation = call_.evaluation;
    x.simulating = simulating_;
  }

  const BlockCall& call_;
  bool simulating_;
  Columns quantities_, conditions_;
  std::vector<T> effects_;
};

/// What is impossible in a block. Few samples leave the limits of few quantities: a stretch of samples is looked
/// through column by column, those that readings share once, and only quantities that leave are checked reading by
/// reading.
template <class M, class T> class Refusals {
  using Rows = typename M::Rows;
  static constexpr std::size_t conditions = rows_of<Rows::template Conditions>, stretch = 256;

public:
  Refusals(const BlockCall& call, const Columns& columns)
      : samples_(call.samples), columns_(columns), leaving_(call.readings), commanded_(call.readings) {
    Group<M, double> first(call, false);
    Reading<Rows, double> at;
    for (std::size_t r = 0; r < call.readings; ++r) {
      first.turn(r, 0, at);
      Outcome<double> outcome;
      check_commanded<M>(at, outcome);
      commanded_[r] = outcome.failed ? Commanded::wrongly : Commanded::well;
      for (std::size_t j = 0; j < conditions; ++j)
        if (call.conditions[r * conditions + j].stride != 0) commanded_[r] = Commanded::each_sample;
    }
  }

  /// Before the samples from i on are checked, for every i in turn.
  void pass(std::size_t i) {
    if (i % stretch != 0) return;
    bool leaves[rows_of<Rows::template Quantities>];
    for (std::size_t r = 0; r < leaving_.size(); ++r) {
      for (const auto& [at, column] : columns_.changed(r))
        leaves[at] = leaves_limits(column, i, std::min(i + stretch, samples_), M::card.quantities[at].limits);
      leaving_[r].clear();
      for (std::size_t j = 0; j < std::size(leaves); ++j)
        if (leaves[j]) leaving_[r].push_back(j);
    }
  }

  /// Refuses the samples of which a quantity lies beyond the card's limits, or that M refuses.
  void check(std::size_t r, const Reading<Rows, T>& at, Outcome<T>& outcome) const {
    for (const std::size_t j : leaving_[r])
      outcome.refuse(!within(M::card.quantities[j].limits, array_of(at.q)[j]));
    if (commanded_[r] == Commanded::wrongly) outcome.refuse(T(0.0) == T(0.0));
    if (commanded_[r] == Commanded::each_sample) check_commanded<M>(at, outcome);
    if constexpr (requires { M::check(at, outcome); })
      if (numbers_in < T >> 1 || !outcome.failed) M::check(at, outcome);
  }

private:
  static bool leaves_limits(const Column& c, std::size_t i, std::size_t end, const Limits& limits) {
    auto fine = within(limits, load<T>(c, i));
    if (c.stride != 0)
      while ((i += numbers_in<T>) < end) fine = fine && within(limits, load<T>(c, i));
    return num::any(!fine);
  }

  enum class Commanded : char { well, wrongly, each_sample };
  std::size_t samples_;
  const Columns& columns_;                        ///< of quantities
  std::vector<std::vector<std::size_t>> leaving_; ///< by reading: quantities that leave their limits in this stretch
  std::vector<Commanded> commanded_;              ///< by reading
};

/// All readings of the first sample.
template <class M> Together<typename M::Rows, double> first_sample(const BlockCall& call) {
  Together<typename M::Rows, double> all;
  Group<M, double>(call, false).together(0, all);
  return all;
}

/// Calls f with the type of a joint evaluation.
template <class M, class F> constexpr void with_joint(int evaluation, const F& f) {
  constexpr int first = [] {
    int e = 0;
    while (!M::card.evaluations[static_cast<std::size_t>(e)].joint()) ++e;
    return e;
  }();
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((evaluation == first + static_cast<int>(i) ? f.template operator()<std::tuple_element_t<i, typename M::Joint>>()
                                                : void()),
     ...);
  }
  (std::make_index_sequence<std::tuple_size_v<typename M::Joint>>{});
}
template <class M> bool is_joint(int evaluation) {
  return M::card.evaluations[static_cast<std::size_t>(evaluation)].joint();
}

} // namespace detail
} // namespace gumshoe::models
