#pragma once
/// Scenarios of the real models and effects, written to files on the fly.
#include "cli/command.h"
#include "propagation/experiment.h"
#include "unit/scenario_fixture.h"

namespace known_case {

using namespace gumshoe;

/// Every model and effect that there is.
inline scenario::Catalogue known() { return cli::catalogue(); }

/// A scenario and its experiment, which refers to it.
struct Case {
  scenario_fixture::Folder folder;
  scenario::Scenario scenario;
  propagation::Experiment experiment;
  explicit Case(const std::string& text)
      : scenario(scenario::read(folder.write("s.toml", text), known())), experiment(scenario) {}
};

} // namespace known_case
