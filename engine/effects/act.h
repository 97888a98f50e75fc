#pragma once
/// Lets freed effects act on a probing event. Models include this; the effects themselves stay behind it, so that a new
/// one recompiles no model.
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Adds to an event; `quantities` are the effect's own, SI.
template <class T> using Apply = void (*)(const T* quantities, chain::ProbingEvent<T>& event);

/// The function of every effect, in the order of cards(). For the scalars that catalogue.cpp and functions_kernels.cpp
/// list; another one does not link until it stands there.
template <class T> std::span<const Apply<T>> functions();

/// Lets the active effects act on an event that is filled in as commanded.
/// @param quantities row of effect quantities, SI, in which each active effect has its place
template <class T> void act(std::span<const Active> active, const T* quantities, chain::ProbingEvent<T>& event) {
  for (const Active& a : active) functions<T>()[a.effect](quantities + a.first, event);
}

} // namespace gumshoe::effects
