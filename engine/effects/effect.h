#pragma once
/// The effects' cards. An effect is a card and one function on one stage of the measuring chain, written once for every
/// model that has that stage.
#include <cstddef>
#include <numbers>
#include <span>

#include "base/card.h"

namespace gumshoe::effects {

inline constexpr double degree = std::numbers::pi / 180, arcsec = degree / 3600; ///< rad

/// Every effect, in the order in which they act.
std::span<const EffectCard* const> cards();
/// Null if there is no such effect.
const EffectCard* find(std::string_view name);
/// True if a model has the stage at which the effect acts.
bool applies(const ModelCard& model, const EffectCard& effect);

/// A freed effect: its place among cards(), and where its quantities start in the row of effect quantities.
struct Active {
  std::size_t effect = 0;
  std::size_t first = 0;
};

} // namespace gumshoe::effects
