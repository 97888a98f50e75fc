#pragma once
/// What effects share that are alike on several parts of a machine: written once, with a card for each part.
#include "chain/rotary_probing.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Effect::add(quantities, part) on the part that `of` picks from an event.
template <class Effect, auto of> struct On {
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) { Effect::add(q, of(event)); }
};

inline constexpr auto slide_X = [](auto& event) -> auto& { return event.x; };
inline constexpr auto slide_Y = [](auto& event) -> auto& { return event.y; };
inline constexpr auto slide_Z = [](auto& event) -> auto& { return event.z; };
inline constexpr auto measured_axis = [](auto& event) -> auto& { return event.axis->slide; };

/// A rotary axis and its angular positioning error, rad.
template <class T> struct Turn {
  const chain::RotaryMotion<T>& axis;
  T& error;
};
inline constexpr auto axis_B = []<class T>(chain::ProbingEvent<T>& event) {
  return Turn<T>{event.rotary->B, event.rotary->B.error[chain::E_B]};
};
inline constexpr auto axis_C = []<class T>(chain::ProbingEvent<T>& event) {
  return Turn<T>{event.rotary->C, event.rotary->C.error[chain::E_C]};
};

/// What the cards of one effect on several parts share, and what each part has of its own.
struct Common {
  Stage stage;
  std::string_view meaning, source;
  std::span<const QuantityCard> quantities;
};
struct Part {
  std::string_view name, title, iso230 = {}, adds, confused_with;
};
/// The card of one part.
constexpr EffectCard on(const Part& part, const Common& common) {
  return {.name = part.name, .title = part.title, .stage = common.stage, .iso230 = part.iso230,
          .meaning = common.meaning, .adds = part.adds, .confused_with = part.confused_with, .source = common.source,
          .quantities = common.quantities};
}

} // namespace gumshoe::effects
