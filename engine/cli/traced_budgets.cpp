#include "cli/traced_budgets.h"

#include <algorithm>
#include <set>

#include "analysis/gum.h"

namespace gumshoe::cli {

store::TracedBudgets traced_budgets(const scenario::Scenario& before, const scenario::Scenario& after) {
  constexpr std::size_t most = 8;
  store::TracedBudgets found;
  if (before.method != scenario::Method::propagation || after.method != scenario::Method::propagation) return found;
  const propagation::Experiment was(before), is(after);
  // Readings of equal labels have outputs of equal names: the first stands for them.
  std::set<std::string> seen;
  for (std::size_t o = 0; o < was.outputs().size() && found.before.size() < most; ++o) {
    const auto same = [&](const auto& output) { return output.name == was.outputs()[o].name; };
    const auto p = std::ranges::find_if(is.outputs(), same);
    if (p == is.outputs().end() || !seen.insert(p->name).second) continue;
    analysis::Budget a = analysis::budget(was, o, before.analysis.coverage_probability);
    analysis::Budget b =
        analysis::budget(is, static_cast<std::size_t>(p - is.outputs().begin()), after.analysis.coverage_probability);
    if (a.combined_standard_uncertainty == 0 && b.combined_standard_uncertainty == 0)
      continue; // exact, before and after
    found.before.push_back(std::move(a));
    found.after.push_back(std::move(b));
  }
  return found;
}

} // namespace gumshoe::cli
