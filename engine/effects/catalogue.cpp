#include "effects/catalogue.h"

#include <algorithm>

namespace gumshoe::effects {

namespace {
#define GUMSHOE_EFFECT(folder, type) &type::card,
constexpr const EffectCard* table[] = {
#include "effects/catalogue.def"
};
#undef GUMSHOE_EFFECT
} // namespace

std::span<const EffectCard* const> cards() { return table; }

const EffectCard* find(std::string_view name) {
  const auto it = std::ranges::find(table, name, &EffectCard::name);
  return it == std::end(table) ? nullptr : *it;
}

bool applies(const ModelCard& model, const EffectCard& effect) {
  return std::ranges::find(model.stages, effect.stage) != model.stages.end();
}

} // namespace gumshoe::effects
