#include <algorithm>

#include "models/model.h"

namespace gumshoe::models {

#define GUMSHOE_MODEL(folder, type)                                                                                    \
  namespace folder {                                                                                                   \
  extern const Model model;                                                                                            \
  }
#include "models/catalogue.def"
#undef GUMSHOE_MODEL

namespace {
#define GUMSHOE_MODEL(folder, type) &folder::model,
const Model* const table[] = {
#include "models/catalogue.def"
};
#undef GUMSHOE_MODEL
} // namespace

std::span<const Model* const> catalogue() { return table; }

const Model* find(std::string_view name) {
  const auto it = std::ranges::find_if(table, [&](const Model* m) { return m->card->name == name; });
  return it == std::end(table) ? nullptr : *it;
}

} // namespace gumshoe::models
