#pragma once
/// The example of every model: those of the catalogue, then those that a scenario describes.
#include <memory>

#include "contracts/subject.h"
#include "propagation/experiment.h"

namespace gumshoe::contracts {

struct Example {
  std::string name; ///< of [model] name
  std::unique_ptr<scenario::Scenario> scenario;
  std::unique_ptr<propagation::Experiment> experiment;
  std::vector<Point> readings; ///< estimates and conditions; no effects, no indications

  const models::Model& model() const { return experiment->model(); }
};

/// Reads engine/models/NAME/example.toml of every model; made anew at every call.
std::vector<Example> examples();

/// Effects of the catalogue that act at a stage of the model's.
std::vector<const EffectCard*> effects_on(const models::Model& model);

} // namespace gumshoe::contracts
