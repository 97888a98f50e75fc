#include "contracts/examples.h"

#include <filesystem>

#include "cli/command.h"
#include "places.h"
#include "scenario/made_models.h"

namespace gumshoe::contracts {

std::vector<Example> examples() {
  std::vector<Example> out;
  const scenario::Catalogue catalogue = cli::catalogue();
  for (const std::string& name : scenario::model_names(catalogue.models)) {
    // The build copies examples to where it builds what they need (a library).
    std::string path = GUMSHOE_EXAMPLES_DIR "/" + name + "/example.toml";
    if (!std::filesystem::exists(path)) path = GUMSHOE_SOURCE_DIR "/engine/models/" + name + "/example.toml";
    Example e{name, std::make_unique<scenario::Scenario>(scenario::read(path, catalogue)), {}, {}};
    e.experiment = std::make_unique<propagation::Experiment>(*e.scenario);
    const std::size_t quantities = e.model().card->quantities.size();
    for (std::size_t r = 0; r < e.scenario->readings.size(); ++r) {
      auto x = e.experiment->reading_point(r);
      x.resize(quantities);
      e.readings.push_back({std::move(x), e.scenario->readings[r].conditions});
    }
    out.push_back(std::move(e));
  }
  return out;
}

std::vector<const EffectCard*> effects_on(const models::Model& model) {
  std::vector<const EffectCard*> out;
  for (const EffectCard* card : effects::cards())
    if (effects::applies(*model.card, *card)) out.push_back(card);
  return out;
}

} // namespace gumshoe::contracts
