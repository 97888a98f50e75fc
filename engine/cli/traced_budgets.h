#pragma once
/// What was found as uncertainty: budgets of the scenario as it was and of the traced one, for the report.
#include "store/trace_file.h"

namespace gumshoe::cli {

/// By the law of propagation (analysis/gum.h), of the first eight outputs that both have and that are not exact; none where a scenario
/// measures nothing or is a virtual experiment, which has no budget.
store::TracedBudgets traced_budgets(const scenario::Scenario& before, const scenario::Scenario& after);

} // namespace gumshoe::cli
