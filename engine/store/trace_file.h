#pragma once
/// The result file of `gumshoe trace` (layout: README.md in this folder).
#include <string>
#include <vector>

#include "analysis/results.h"
#include "base/card.h"
#include "store/draft.h"
#include "tracing/trace.h"

namespace gumshoe::store {

/// Uncertainty budgets of the scenario as it was and with what was found; both empty if nothing was added.
struct TracedBudgets {
  std::vector<analysis::Budget> before, after;
};

/// Adds the whole file to the draft. `card`: of the scenario's model; `rounds`: the first is of `trace`, and one alone is
/// not written. Throws OutputError naming path and reason.
void write_trace(Draft& draft, const Claim& claim, const scenario::Scenario& scenario, const ModelCard& card,
                 const tracing::Trace& trace, const TracedBudgets& budgets,
                 const std::vector<tracing::Round>& rounds = {});

} // namespace gumshoe::store
