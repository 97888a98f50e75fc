#include "cli/traced_budgets.h"

#include <algorithm>
#include <map>
#include <set>

#include "analysis/gum.h"

namespace gumshoe::cli {
namespace {

/// Budgets by output, those of a reading at once.
class Budgets {
public:
  explicit Budgets(const propagation::Experiment& e) : e_(e) {}
  const analysis::Budget& operator()(std::size_t output) {
    const std::size_t measurand = output % e_.measurands().size(), first = output - measurand;
    auto& known = by_reading_[first];
    if (known.empty()) known = analysis::budgets(e_, first, e_.scenario().analysis.coverage_probability);
    return known[measurand];
  }

private:
  const propagation::Experiment& e_;
  std::map<std::size_t, std::vector<analysis::Budget>> by_reading_;
};

} // namespace

store::TracedBudgets traced_budgets(const scenario::Scenario& before, const scenario::Scenario& after) {
  constexpr std::size_t most = 8;
  store::TracedBudgets found;
  if (before.method != scenario::Method::propagation || after.method != scenario::Method::propagation) return found;
  const propagation::Experiment was(before), is(after);
  Budgets of_was(was), of_is(is);
  // Readings of equal labels have outputs of equal names: the first stands for them.
  std::set<std::string> seen;
  for (std::size_t o = 0; o < was.outputs().size() && found.before.size() < most; ++o) {
    const auto same = [&](const auto& output) { return output.name == was.outputs()[o].name; };
    const auto p = std::ranges::find_if(is.outputs(), same);
    if (p == is.outputs().end() || !seen.insert(p->name).second) continue;
    analysis::Budget a = of_was(o), b = of_is(static_cast<std::size_t>(p - is.outputs().begin()));
    if (a.combined_standard_uncertainty == 0 && b.combined_standard_uncertainty == 0)
      continue; // exact, before and after
    found.before.push_back(std::move(a));
    found.after.push_back(std::move(b));
  }
  return found;
}

} // namespace gumshoe::cli
