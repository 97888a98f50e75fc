#include <algorithm>
#include <cmath>

#include "quantities/cells.h"
#include "tracing/findings.h"

namespace gumshoe::tracing {
namespace {

struct Line {
  calibration::Unknown unknown;
  double value = 0, u = 0;
  Index column = -1; ///< of the fit's fixed ones; -1: exact
};

calibration::Unknown unknown_of(const scenario::Scenario& s, std::size_t quantity, std::size_t entry,
                                const std::string& name) {
  calibration::Unknown u;
  u.name = name;
  u.quantity = quantity;
  u.entry = entry;
  u.unit = s.quantities[quantity].unit;
  u.si_unit = s.quantities[quantity].si_unit;
  return u;
}

} // namespace

void estimate_for_scenario(const Circumstances& c, const Search& s, Trace& out) {
  const JointFit& fit = s.found;
  scenario::Scenario& scenario = out.extended;
  std::vector<Line> lines;
  // Of the entry's first reading.
  const auto value_at = [&](std::size_t quantity, const auto& holds) {
    for (std::size_t r = 0; r < fit.at.size(); ++r)
      if (holds(r)) return fit.at[r][quantity];
    return 0.0;
  };
  for (std::size_t u = 0; u < c.fitter.unknowns().size(); ++u) {
    const FreeUnknown& free = c.fitter.unknowns()[u];
    const auto column = static_cast<Index>(u);
    if (!std::isfinite(fit.covariance(column, column))) continue;
    lines.push_back({unknown_of(scenario, free.quantity, free.entry, free.name),
                     value_at(free.quantity, [&](std::size_t r) { return free.holds[r]; }),
                     std::sqrt(fit.covariance(column, column)), column});
  }
  bool any = false;
  for (std::size_t t = 0; t < fit.terms.size(); ++t) {
    const Term& term = fit.terms[t];
    for (const auto& [shape, value] : term.alternative.held)
      lines.push_back({unknown_of(scenario, shape, 0, scenario.quantities[shape].name), value, 0, -1});
    for (std::size_t j = 0; j < term.alternative.amplitudes.size(); ++j) {
      const Amplitude& a = term.alternative.amplitudes[j];
      if (a.scenario_name.empty()) continue;
      any = true;
      const Index column = first_column(fit, t) + static_cast<Index>(j);
      const double u = std::sqrt(fit.covariance(column, column));
      auto quantity = a.quantity;
      if (quantity == Amplitude::npos) {
        for (std::size_t q = 0; q < scenario.quantities.size(); ++q)
          if (scenario.quantities[q].name == a.scenario_name) quantity = q;
        if (quantity == Amplitude::npos) {
          quantity = scenario.quantities.size();
          scenario.quantities.push_back({a.scenario_name, a.unit, a.si_unit, {quantities::Entry{}}, true});
        }
        lines.push_back(
            {unknown_of(scenario, quantity, 0, a.scenario_name), term.size[static_cast<Index>(j)], u, column});
        continue;
      }
      // An effect has one entry; a declared quantity those that the shift moves.
      auto& entries = scenario.quantities[quantity].entries;
      bool found = false;
      for (std::size_t e = 0; e < entries.size(); ++e) {
        const bool inside = a.labels.empty() || quantities::holds_for(a.labels, entries[e].labels);
        if (!inside) continue;
        found = true;
        const auto holds = [&](std::size_t r) {
          return quantities::holds_for(entries[e].labels, c.experiment.scenario().readings[r].labels);
        };
        const std::string name = scenario.quantities[quantity].name +
                                 (entries[e].labels.empty() ? "" : "[" + quantities::text_of(entries[e].labels) + "]");
        lines.push_back({unknown_of(scenario, quantity, e, name), value_at(quantity, holds), u, column});
      }
      if (!found)
        out.statements.push_back("the scenario has no value of " + scenario.quantities[quantity].name + " for " +
                                 quantities::text_of(a.labels) +
                                 " alone: state it by label to take the found value in");
    }
  }
  if (!any) return;
  const std::size_t n = lines.size();
  calibration::Estimate& e = out.estimate;
  e.noise_declared = true; // u as found, no degrees of freedom
  e.covariance.assign(n * n, 0);
  e.correlation.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    e.parameters.push_back({lines[i].unknown, lines[i].value, lines[i].u, false});
    scenario.quantities[lines[i].unknown.quantity].estimated = true;
    for (std::size_t j = 0; j < n; ++j) {
      if (lines[i].column < 0 || lines[j].column < 0) continue;
      const double covariance = fit.covariance(lines[i].column, lines[j].column);
      e.covariance[i * n + j] = covariance;
      e.correlation[i * n + j] = i == j ? 1 : std::clamp(covariance / (lines[i].u * lines[j].u), -1.0, 1.0);
    }
  }
  for (const Row& row : out.rows)
    if (!row.final) e.rows.push_back({row.reading, row.indication});
}

} // namespace gumshoe::tracing
