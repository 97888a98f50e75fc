#pragma once
/// The effects as tables of engine/effects/README.md.
#include <span>
#include <string>

#include "base/card.h"

namespace gumshoe::cli {

/// Typical magnitude in the quantity's unit, "0.1-5 ms"; empty if it is not known.
std::string typical_text(const QuantityCard& quantity);

/// Markdown: the stages with the models that have them, then a row per effect in the order in which they act.
std::string effects_markdown(std::span<const ModelCard* const> models, std::span<const EffectCard* const> effects);

} // namespace gumshoe::cli
