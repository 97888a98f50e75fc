#include "scenario/made_models.h"

namespace gumshoe::scenario {

#define GUMSHOE_MADE_MODEL(name, what, starts) models::MadeModel make_##name(const MadeModelSource& source);
#include "scenario/made_models.def"
#undef GUMSHOE_MADE_MODEL

std::span<const MadeModelRow> made_models() {
#define GUMSHOE_MADE_MODEL(name, what, starts) {#name, what, &make_##name, starts},
  static constexpr MadeModelRow rows[] = {
#include "scenario/made_models.def"
  };
#undef GUMSHOE_MADE_MODEL
  return rows;
}

std::vector<std::string> model_names(std::span<const ModelCard* const> catalogue) {
  std::vector<std::string> names;
  for (const ModelCard* card : catalogue) names.emplace_back(card->name);
  for (const MadeModelRow& row : made_models()) names.emplace_back(row.name);
  return names;
}

} // namespace gumshoe::scenario
