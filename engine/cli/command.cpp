#include "cli/command.h"

#include <cmath>

#include "effects/catalogue.h"

namespace gumshoe::cli {

scenario::Catalogue catalogue() {
  scenario::Catalogue c;
  for (const models::Model* m : models::catalogue()) c.models.push_back(m->card);
  for (const EffectCard* e : effects::cards()) c.effects.push_back(e);
  c.applies = &effects::applies;
  return c;
}

std::uint64_t whole_number(const std::string& text, const std::string& option) {
  std::size_t used = 0;
  double x = 0;
  try {
    x = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(x >= 1) || x > 1e15 || x != std::floor(x))
    throw InputError(option + ": '" + text + "' is not a positive whole number", "", "1e6, say?");
  return static_cast<std::uint64_t>(x);
}

} // namespace gumshoe::cli
