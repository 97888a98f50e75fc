#include "analysis/shared_inputs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "analysis/validation.h"
#include "base/error.h"
#include "scenario/document.h"

namespace gumshoe::analysis {

const Budget* budget_of(const Results& result, const std::string& output) {
  for (const Budget& b : result.budgets)
    if (b.output.name == output) return &b;
  return nullptr;
}

const Contribution* find_contribution(const Budget* budget, const std::string& component) {
  if (!budget) return nullptr;
  const auto at = std::ranges::find(budget->contributions, component, &Contribution::name);
  return at == budget->contributions.end() ? nullptr : &*at;
}

double signed_contribution(const Contribution& c) { return c.sensitivity * c.standard_uncertainty; }

bool alike(const Contribution& a, const Contribution& b) {
  return a.evaluation == 'B' && b.evaluation == 'B' && a.standard_uncertainty > 0 &&
         a.standard_uncertainty == b.standard_uncertainty && a.distribution == b.distribution;
}

std::string correlated_with(const Results& r, const std::string& quantity) {
  if (r.scenario_text.empty()) return "";
  const scenario::Node document = scenario::parse_document(r.scenario_text, r.scenario_file);
  const scenario::Node* const rows = scenario::find_member(document, "correlations");
  for (const scenario::Node& row : rows ? rows->items : std::vector<scenario::Node>{}) {
    const scenario::Node* const names = scenario::find_member(row, "quantities");
    if (!names || std::ranges::find(names->items, quantity, &scenario::Node::text) == names->items.end()) continue;
    for (const scenario::Node& other : names->items)
      if (other.text != quantity) return other.text;
  }
  return "";
}

void require_shared(std::span<const std::string> wanted, std::span<const Results* const> results) {
  std::map<std::string, std::size_t> known; // in how many results
  for (const Results* r : results) {
    std::set<std::string> names;
    for (const Budget& b : r->budgets)
      for (const Contribution& c : b.contributions) names.insert(c.quantity);
    for (const std::string& name : names) ++known[name];
  }
  std::vector<std::string> shared;
  for (const auto& [name, count] : known)
    if (count > 1) shared.push_back(name);
  std::vector<Problem> problems;
  for (const std::string& name : wanted) {
    if (std::ranges::find(shared, name) != shared.end()) continue;
    const std::string near = nearest(name, shared);
    problems.push_back({{},
                        fmt::format("--same {}: not a quantity in the budgets of {}", name,
                                    results.size() == 2 ? "both results" : "two of the results"),
                        "",
                        near.empty() ? "" : "did you mean '" + near + "'?"});
  }
  for (const Results* r : results)
    for (const std::string& name : wanted)
      if (const std::string other = correlated_with(*r, name); !other.empty())
        problems.push_back({{},
                            fmt::format("--same {}: it is correlated with {}", name, other),
                            "what the results share by that is not known from their budgets",
                            "leave it out, or evaluate both measurements in one scenario"});
  if (!problems.empty()) throw InputError(std::move(problems));
}

void require_proportional(std::span<const std::string> same, const Budget* budget, const Summary& summary,
                          const std::string& where) {
  if (!budget || accounts_for_variance(*budget, summary)) return;
  constexpr double apart = 0.05;
  std::map<std::string, std::pair<double, double>> shares; // by quantity: of the law, and of the samples
  for (const Contribution& c : budget->contributions) {
    if (std::ranges::find(same, c.quantity) == same.end()) continue;
    const double u = signed_contribution(c) / summary.standard_uncertainty;
    if (!std::isfinite(u)) return; // refused for that
    shares[c.quantity].first += u * u * variance_over_scale(c);
    shares[c.quantity].second += c.monte_carlo_share;
  }
  for (const auto& [name, share] : shares)
    if (!(std::fabs(share.first - share.second) <= apart))
      throw InputError(
          fmt::format("{} depends on {} otherwise than in proportion, or may", where, name),
          "the law of propagation does not account for its variance, and what the results share is not known from it",
          std::isfinite(share.second) ? "evaluate both measurements in one scenario"
                                      : "evaluate both measurements in one scenario, or run them with sensitivity = { "
                                        "sobol = 65536 } in [analysis]");
}

void require_one_coverage(std::span<const Results* const> results) {
  for (const Results* r : results)
    if (r->coverage_probability != results[0]->coverage_probability)
      throw InputError("the results have different coverage probabilities",
                       fmt::format("{} and {}", results[0]->coverage_probability, r->coverage_probability),
                       "state the same coverage_probability in [analysis] of all, and use gumshoe analyse");
}

} // namespace gumshoe::analysis
