#include "tracing/fit/starting_values.h"

#include "base/error.h"
#include "calibration/estimate.h"

namespace gumshoe::tracing {

std::optional<scenario::Scenario> at_estimates(const scenario::Scenario& scenario, int threads) {
  try {
    const auto estimate = calibration::estimate(propagation::Experiment(scenario), {threads});
    if (!estimate.solver.converged) return std::nullopt;
    scenario::Scenario out = scenario;
    bool moved = false;
    for (const calibration::Parameter& p : estimate.parameters) {
      if (p.unknown.prior_u > 0) continue;
      out.quantities[p.unknown.quantity].entries[p.unknown.entry].value = p.value;
      moved = true;
    }
    return moved ? std::optional(std::move(out)) : std::nullopt;
  } catch (const InputError&) { // what cannot be estimated may be traced all the same
    return std::nullopt;
  }
}

} // namespace gumshoe::tracing
