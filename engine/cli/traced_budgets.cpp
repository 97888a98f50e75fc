#include "cli/traced_budgets.h"

#include "analysis/gum.h"

namespace gumshoe::cli {

store::TracedBudgets traced_budgets(const scenario::Scenario& before, const scenario::Scenario& after) {
  constexpr std::size_t most = 8;
  store::TracedBudgets found;
  if (before.method != scenario::Method::propagation || after.method != scenario::Method::propagation) return found;
  const propagation::Experiment was(before), is(after);
  for (std::size_t o = 0; o < was.outputs().size() && found.before.size() < most; ++o)
    for (std::size_t p = 0; p < is.outputs().size(); ++p) {
      if (was.outputs()[o].name != is.outputs()[p].name) continue;
      found.before.push_back(analysis::budget(was, o, before.analysis.coverage_probability));
      found.after.push_back(analysis::budget(is, p, after.analysis.coverage_probability));
      break;
    }
  return found;
}

} // namespace gumshoe::cli
