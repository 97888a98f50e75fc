#pragma once
/// The part of the JSON Schema of scenarios that follows from the effects' cards.
#include <span>
#include <string>

#include "base/card.h"

namespace gumshoe::scenario {

/// The schema of the section `effects`, as JSON text: an object per effect whose quantities are each a
/// "#/definitions/quantity". Effects that the schema does not know may have any quantities, so that editors accept
/// scenarios of later versions.
std::string effects_schema(std::span<const EffectCard* const> effects);

} // namespace gumshoe::scenario
