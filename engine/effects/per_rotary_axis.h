#pragma once
/// What effects of a rotary axis share: each is written once, and has a card for B and one for C.
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// What one axis was commanded, and its positioning error, rad.
template <class T> struct RotaryAxis {
  const T &angle, &direction, &clamped;
  T& error;
};

/// The common card under the name it has for B or C; C acts after B.
constexpr EffectCard of_axis(EffectCard card, char axis, std::string_view name, std::string_view title,
                             std::string_view confused_with) {
  card.name = name;
  card.title = title;
  card.iso230 = axis == 'B' ? "E_BB" : "E_CC";
  card.confused_with = confused_with;
  if (axis == 'C') ++card.rank;
  return card;
}

template <class Effect> struct OfB {
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    Effect::add(q, RotaryAxis<T>{r.B, r.B_direction, r.B_clamped, r.B_error[chain::E_B]});
  }
};
template <class Effect> struct OfC {
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::RotaryProbing<T>& r = *event.rotary;
    Effect::add(q, RotaryAxis<T>{r.C, r.C_direction, r.C_clamped, r.C_error[chain::E_C]});
  }
};

} // namespace gumshoe::effects
