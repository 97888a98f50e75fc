#pragma once
/// One reading as a model's physics sees it, and how a computation with it ended.
///
/// T is the scalar that the physics runs on: double, Lanes (several samples at once) or a dual number.
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "base/status.h"
#include "effects/act.h"
#include "math/dual_order.h"
#include "math/scalar.h"
#include "models/named.h"

namespace gumshoe::models {

/// The effects that a scenario frees, with their quantities; none by default.
template <class T> struct Freed {
  std::span<const effects::Active> active;
  const T* quantities = nullptr; ///< SI
  bool any() const { return !active.empty(); }
  /// Lets them act on an event that is filled in as commanded.
  void act(chain::ProbingEvent<T>& event) const { effects::act(active, quantities, event); }
};

/// Rows declares the names of a card's rows: Quantities, Conditions, Indications, Measurands (GUMSHOE_NAMED). All SI.
template <class Rows, class T> struct Reading {
  typename Rows::template Quantities<T> q;
  typename Rows::template Conditions<T> c; ///< commanded, exact: without derivatives
  Freed<T> freed;
  int evaluation = 0;      ///< row of the card's evaluations
  bool simulating = false; ///< the machine is asked for, not the measurement model
  const void* context = nullptr; ///< Model::context: of the machine that a scenario describes
};

/// What the machine shows, and what is true there.
template <class Rows, class T> struct Simulated {
  typename Rows::template Indications<T> indications;
  typename Rows::template Measurands<T> measurands;
};

/// How many numbers a T holds, and one of them; a mask likewise.
template <class T> inline constexpr std::size_t numbers_in = 1;
template <> inline constexpr std::size_t numbers_in<Lanes> = Lanes::size;
inline bool holds_at(bool mask, std::size_t) { return mask; }
inline bool holds_at(const Lanes::batch_bool_type& mask, std::size_t lane) { return mask.get(lane); }

/// The status of each number that a T holds. The first failure of a number stays.
template <class T> struct Outcome {
  std::array<Status, numbers_in<T>> status{}; ///< Status::ok
  bool failed = false;                        ///< any of them
  bool kink = false;                          ///< values are right, derivatives do not exist here
  const char* why = nullptr;                  ///< of the first refusal

  void fail(std::size_t at, Status with) {
    if (status[at] == Status::ok) status[at] = with;
    failed |= with != Status::ok;
  }
  void fail(Status with) { fail(0, with); }
  /// out_of_domain where the mask holds. @param reason names the quantity and says what is wrong; without one, what
  /// scenario and table refuse before, so that only samples can meet it
  template <class Mask> void refuse(const Mask& where, const char* reason = nullptr) {
    if (!num::any(where)) return;
    if (!why) why = reason;
    for (std::size_t i = 0; i < status.size(); ++i)
      if (holds_at(where, i)) fail(i, Status::out_of_domain);
  }
};

} // namespace gumshoe::models
