/// Where an earlier trace of the same readings left the declared draws.
#include <algorithm>

#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {
namespace {

using quantities::InputQuantity;

bool tied(const quantities::SamplePlan& plan, std::size_t v) {
  return std::ranges::any_of(
      plan.copulas, [&](const auto& group) { return std::ranges::find(group.variates, v) != group.variates.end(); });
}

/// Whether what was declared of a quantity stands in [trace] priors, and is not released.
bool of_draws(const InputQuantity& prior) {
  return std::ranges::any_of(prior.entries, [](const auto& entry) { return !entry.components.empty(); });
}

} // namespace

void Fitter::start_from(const scenario::Scenario& scenario) {
  const auto& priors = scenario.trace.priors;
  if (!scenario.data.empty() || std::ranges::none_of(priors, of_draws)) return; // other readings, or no earlier trace
  const auto& plan = experiment_.plan();
  const auto& quantities = experiment_.scenario().quantities;
  for (std::size_t v = 0; v < draws_.size(); ++v) {
    const quantities::Variate& variate = plan.variates[v];
    const InputQuantity& declared = quantities[variate.quantity];
    const auto& components = declared.entries[variate.entry].components;
    if (!components[variate.component].per.empty() || tied(plan, v)) continue; // no trace says what it found of these
    if (std::ranges::find(priors, declared.name, &InputQuantity::name) == priors.end()) {
      draws_[v].fitted = false; // readings jumped with it
      continue;
    }
    const auto known = std::ranges::find(scenario.quantities, declared.name, &InputQuantity::name);
    if (known == scenario.quantities.end() || known->entries.size() != declared.entries.size()) continue;
    const double moved = known->entries[variate.entry].value - declared.entries[variate.entry].value;
    // Where one of several components moved, which of them is not told.
    if (moved == 0 || components.size() != 1) continue;
    draws_[v].fitted = true;
    earlier_[index(v)] = (moved - variate.distribution.mean()) / draws_[v].u;
  }
}

} // namespace gumshoe::tracing
