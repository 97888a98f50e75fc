#pragma once
/// An effect: a card and one function on one stage of the measuring chain, written once for every
/// model that has that stage. A row of the catalogue carries it over the closed list of scalars.
#include <cstddef>
#include <span>

#include "base/card.h"

namespace gumshoe::effects {

/// Every effect, in the order in which they act (stage, then rank).
std::span<const EffectCard* const> cards();
const EffectCard* find(std::string_view name);
/// True if a model has the stage at which the effect acts.
bool applies(const ModelCard& model, const EffectCard& effect);

/// A freed effect: which one, and where its quantities start in the row of effect quantities.
struct Active {
  std::size_t effect = 0;
  std::size_t first = 0;
};

} // namespace gumshoe::effects
