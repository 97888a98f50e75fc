#include <algorithm>

#include "effects/functions.h"

namespace gumshoe::effects {

namespace {
#define GUMSHOE_EFFECT(folder, type) &type::card,
constexpr const EffectCard* table[] = {
#include "effects/catalogue.def"
};
#undef GUMSHOE_EFFECT
static_assert(std::ranges::is_sorted(table, {}, &EffectCard::stage), "catalogue.def is in the order of the stages");
} // namespace

std::span<const EffectCard* const> cards() { return table; }

const EffectCard* find(std::string_view name) {
  const auto it = std::ranges::find(table, name, &EffectCard::name);
  return it == std::end(table) ? nullptr : *it;
}

bool applies(const ModelCard& model, const EffectCard& effect) {
  return std::ranges::find(model.stages, effect.stage) != model.stages.end();
}

using Slope = Dual<double, 1>;
using Gradient = Dual<double, 8>;
using Curvature = Dual<Gradient, 8>;
template std::span<const Apply<double>> functions<double>();
template std::span<const Apply<Lanes>> functions<Lanes>();
template std::span<const Apply<Slope>> functions<Slope>();
template std::span<const Apply<Gradient>> functions<Gradient>();
template std::span<const Apply<Curvature>> functions<Curvature>();

} // namespace gumshoe::effects
