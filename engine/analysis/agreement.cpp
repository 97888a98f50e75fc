#include "analysis/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/shared_inputs.h"
#include "analysis/validation.h"
#include "base/error.h"
#include "base/special_values.h"

namespace gumshoe::analysis {
namespace {

std::vector<ContributionChange> changes(const Budget* before, const Budget* after) {
  std::map<std::string, ContributionChange> squares;
  const auto add = [&](const Budget* budget, double ContributionChange::*side) {
    if (budget)
      for (const Contribution& c : budget->contributions) squares[c.quantity].*side += c.contribution * c.contribution;
  };
  add(before, &ContributionChange::before);
  add(after, &ContributionChange::after);
  std::vector<ContributionChange> out;
  for (const auto& [name, sum] : squares)
    if (sum.before != sum.after && std::isfinite(sum.before) && std::isfinite(sum.after))
      out.push_back({name, sum.before, sum.after});
  std::ranges::stable_sort(out, std::greater{}, [](const auto& c) { return std::fabs(c.after - c.before); });
  for (auto& c : out) c.before = std::sqrt(c.before), c.after = std::sqrt(c.after);
  return out;
}

/// Square of an uncertainty of the difference; a negative one is the first order's rounding.
double root(double square) { return square > 0 ? std::sqrt(square) : square <= 0 ? 0 : nan; }

Agreement agreement(const Summary& samples_before, const Summary& samples_after, const Budget* budget_before,
                    const Budget* budget_after, const std::vector<std::string>& same) {
  const Summary before = with_stated_uncertainty(samples_before, budget_before),
                after = with_stated_uncertainty(samples_after, budget_after);
  Agreement out;
  out.before = before, out.after = after;
  out.after.output.unit = before.output.unit;
  require_proportional(same, budget_before, samples_before, "before: " + before.output.name);
  require_proportional(same, budget_after, samples_after, "after: " + after.output.name);
  double shared = 0;
  std::vector<std::pair<std::string, double>> maybe; // quantities alike, with their covariance
  if (budget_before)
    for (const Contribution& a : budget_before->contributions) {
      const Contribution* b = find_contribution(budget_after, a.name);
      if (!b) continue;
      const double both = signed_contribution(a) * signed_contribution(*b);
      if (std::ranges::find(same, a.quantity) != same.end()) {
        if (!std::isfinite(both))
          throw InputError("--same " + a.quantity + ": its covariance is unknown",
                           before.output.name + " has no sensitivity coefficient for it");
        shared += both;
        out.counted.push_back(a.name);
      } else if (alike(a, *b) && both != 0 && std::isfinite(both)) {
        if (maybe.empty() || maybe.back().first != a.quantity) maybe.emplace_back(a.quantity, 0);
        maybe.back().second += both;
      }
    }
  auto& d = out.difference;
  d.name = before.output.name, d.a = "after", d.b = "before";
  d.unit = before.output.unit, d.si_unit = before.output.si_unit;
  d.difference = after.estimate - before.estimate;
  d.root_sum_square = std::hypot(before.standard_uncertainty, after.standard_uncertainty);
  d.standard_uncertainty = root(d.root_sum_square * d.root_sum_square - 2 * shared);
  const double expanded = std::hypot(before.expanded_uncertainty, after.expanded_uncertainty);
  const double factors = shared == 0 ? 1 : before.coverage_factor * after.coverage_factor;
  d.expanded_uncertainty = root(expanded * expanded - 2 * factors * shared);
  d.normalised_error = d.expanded_uncertainty > 0 ? d.difference / d.expanded_uncertainty : nan;
  // The relative change of u(d) is cov / u(d)^2.
  for (const auto& [name, both] : maybe)
    if (std::fabs(both) > 0.01 * d.standard_uncertainty * d.standard_uncertainty) out.alike.push_back(name);
  out.changes = changes(budget_before, budget_after);
  return out;
}

} // namespace

Agreements agreements(const Results& before, const Results& after, const std::vector<std::string>& same) {
  const std::array results{&before, &after};
  require_one_coverage(results);
  require_shared(same, results);
  Agreements out;
  for (const Summary& a : before.summaries) {
    if (a.output.diagnostic) continue;
    const auto name = [](const Summary& s) { return s.output.name; };
    const auto b = std::ranges::find(after.summaries, a.output.name, name);
    if (b == after.summaries.end()) {
      out.only_before.push_back(a.output.name);
      continue;
    }
    if (a.output.si_unit != b->output.si_unit)
      throw InputError(a.output.name + ": the results have different dimensions",
                       fmt::format("{} and {}", a.output.unit, b->output.unit));
    out.rows.push_back(agreement(a, *b, budget_of(before, a.output.name), budget_of(after, a.output.name), same));
  }
  for (const Summary& b : after.summaries)
    if (!b.output.diagnostic &&
        std::ranges::none_of(before.summaries, [&](const Summary& a) { return a.output.name == b.output.name; }))
      out.only_after.push_back(b.output.name);
  if (out.rows.empty())
    throw InputError("the results have no measurand in common",
                     fmt::format("{} against {}", fmt::join(out.only_before, ", "), fmt::join(out.only_after, ", ")),
                     "labels are part of a name. Use the same labels in both scenarios");
  return out;
}

} // namespace gumshoe::analysis
