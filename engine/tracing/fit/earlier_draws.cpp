/// Where an earlier trace of the same readings left the declared draws.
#include <algorithm>

#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

void Fitter::start_from(const scenario::Scenario& scenario) {
  if (!scenario.data.empty()) return; // other readings
  const auto& plan = experiment_.plan();
  const auto& quantities = experiment_.scenario().quantities;
  for (std::size_t v = 0; v < draws_.size(); ++v) {
    const quantities::Variate& variate = plan.variates[v];
    const quantities::InputQuantity& declared = quantities[variate.quantity];
    if (std::ranges::find(scenario.trace.priors, declared.name, &quantities::InputQuantity::name) ==
        scenario.trace.priors.end())
      continue;
    const auto known = std::ranges::find(scenario.quantities, declared.name, &quantities::InputQuantity::name);
    const auto& entry = declared.entries[variate.entry];
    if (known == scenario.quantities.end() || known->entries.size() != declared.entries.size()) continue;
    const double moved = known->entries[variate.entry].value - entry.value;
    // Where one of several components moved, which of them is not told.
    if (moved == 0 || entry.components.size() != 1 || !entry.components[0].per.empty()) continue;
    draws_[v].fitted = true;
    earlier_[index(v)] = (moved - variate.distribution.mean()) / draws_[v].u;
  }
}

} // namespace gumshoe::tracing
