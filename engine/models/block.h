#pragma once
/// The readings of a block call under their names, one group of samples at a time.
#include <cmath>
#include <type_traits>
#include <vector>

#include "models/model.h"
#include "models/reading.h"

namespace gumshoe::models {

/// All readings of the samples at hand, for joint evaluations.
template <class Rows, class T> struct Together {
  std::vector<Reading<Rows, T>> at;
  std::vector<typename Rows::template Indications<T>> read; ///< empty while simulating
  const Declared* declared = nullptr;                       ///< null where nothing is declared: a table
  std::size_t size() const { return at.size(); }
};

namespace detail {

template <class T> T load(const Column& c, std::size_t i) {
  if constexpr (std::is_same_v<T, Lanes>)
    return c.stride == 0 ? Lanes(c.data[0]) : Lanes::load_unaligned(c.data + i);
  else
    return c.data[c.stride * i];
}
inline void store_at(const Lanes& value, double* to) { value.store_unaligned(to); }
inline void store_at(double value, double* to) { *to = value; }

/// Refuses conditions that are not finite, or that M refuses.
template <class M, class T> void check_commanded(const Reading<typename M::Rows, T>& at, Outcome<T>& outcome) {
  for (std::size_t j = 0; j < M::card.conditions.size(); ++j)
    outcome.refuse(!(num::abs(array_of(at.c)[j]) < T(1e300)), "a condition is not finite");
  if constexpr (requires { M::check_commanded(at, outcome); }) M::check_commanded(at, outcome);
}

/// @tparam T double, or Lanes
template <class M, class T> class Group {
  using Rows = typename M::Rows;
  static constexpr std::size_t quantities = rows_of<Rows::template Quantities>,
                               conditions = rows_of<Rows::template Conditions>,
                               shown = rows_of<Rows::template Indications>;

public:
  using Indications = typename Rows::template Indications<T>;

  Group(const BlockCall& call, bool simulating)
      : call_(call), simulating_(simulating), effects_(call.readings * call.effect_quantities), limited_(call.readings),
        commanded_(call.readings, Commanded::well) {
    for (std::size_t r = 0; r < call.readings; ++r) {
      for (std::size_t j = 0; j < quantities; ++j) {
        const Column& c = call.quantities[r * quantities + j];
        const Limits& l = M::card.quantities[j].limits;
        if (c.stride != 0 || !l.contain(*c.data))
          limited_[r].push_back({j, l.low_open ? std::nextafter(l.low, l.high) : l.low,
                                 l.high_open ? std::nextafter(l.high, l.low) : l.high});
      }
      Outcome<double> outcome;
      check_commanded<M>(loaded<double>(r, 0), outcome);
      if (outcome.failed) commanded_[r] = Commanded::wrongly;
      for (std::size_t j = 0; j < conditions; ++j)
        if (call.conditions[r * conditions + j].stride != 0) commanded_[r] = Commanded::each_sample;
    }
  }

  /// Reading r of the samples from i on. Its effects' quantities stay until the next call for r.
  Reading<Rows, T> at(std::size_t r, std::size_t i) {
    auto x = loaded<T>(r, i);
    const std::size_t n = call_.effect_quantities;
    for (std::size_t j = 0; j < n; ++j) effects_[r * n + j] = load<T>(call_.effects[r * n + j], i);
    x.freed = {call_.active, effects_.data() + r * n};
    return x;
  }
  Indications read(std::size_t r, std::size_t i) const {
    Indications x;
    for (std::size_t k = 0; k < shown; ++k) array_of(x)[k] = load<T>(call_.indications[r * shown + k], i);
    return x;
  }
  /// Refuses the samples of which a quantity lies beyond the card's limits, or that M refuses.
  void check(std::size_t r, const Reading<Rows, T>& at, Outcome<T>& outcome) const {
    auto fine = T(0.0) == T(0.0);
    for (const Closed& l : limited_[r]) {
      const T& x = array_of(at.q)[l.quantity];
      fine = fine && (x >= T(l.low)) && (x <= T(l.high));
    }
    outcome.refuse(!fine, "a quantity is outside its limits");
    if (commanded_[r] == Commanded::wrongly) outcome.refuse(T(0.0) == T(0.0), "a condition is impossible");
    if (commanded_[r] == Commanded::each_sample) check_commanded<M>(at, outcome);
    if constexpr (requires { M::check(at, outcome); })
      if (numbers_in < T >> 1 || !outcome.failed) M::check(at, outcome);
  }

private:
  template <class U> Reading<Rows, U> loaded(std::size_t r, std::size_t i) const {
    Reading<Rows, U> x;
    for (std::size_t j = 0; j < quantities; ++j) array_of(x.q)[j] = load<U>(call_.quantities[r * quantities + j], i);
    for (std::size_t j = 0; j < conditions; ++j) array_of(x.c)[j] = load<U>(call_.conditions[r * conditions + j], i);
    x.freed.active = call_.active;
    x.evaluation = call_.evaluation;
    x.simulating = simulating_;
    return x;
  }

  struct Closed {
    std::size_t quantity;
    double low, high; ///< that are in
  };
  enum class Commanded : char { well, wrongly, each_sample };
  const BlockCall& call_;
  bool simulating_;
  std::vector<T> effects_;
  std::vector<std::vector<Closed>> limited_; ///< by reading: quantities that may leave their limits in this block
  std::vector<Commanded> commanded_;         ///< by reading
};

/// All readings of one sample, as numbers.
template <class M> Together<typename M::Rows, double> first_sample(const BlockCall& call, Group<M, double>& group) {
  Together<typename M::Rows, double> all;
  all.declared = call.declared;
  for (std::size_t r = 0; r < call.readings; ++r) {
    all.at.push_back(group.at(r, 0));
    if (call.indications) all.read.push_back(group.read(r, 0));
  }
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
