#include "tracing/findings/splitting.h"

#include <algorithm>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "base/units.h"
#include "tracing/criteria.h"
#include "tracing/judgement/holdout.h"
#include "tracing/planning/planning.h"

namespace gumshoe::tracing {
namespace {

using scenario::Scenario;

constexpr double usual_warming = 10;        ///< K: where all readings have one temperature
constexpr std::size_t planned_settings = 4; ///< settings of a plan that a sentence names

/// Readings like those of one block, with one condition changed.
struct Proposal {
  std::size_t condition = 0;
  double value = 0; ///< SI; of an angle and of the direction: added, or -1 for "the other way"
  enum { set, add, reverse } how = set;
  std::string words;
};

std::string shown(double si, const VariableCard& card) {
  const std::string unit(card.unit);
  return fmt::format("{:.4g}{}", units::from_si(si, unit, std::string(card.si_unit)), units::suffix(unit));
}

std::vector<Proposal> proposals(const ModelCard& card, const Scenario& s) {
  std::vector<Proposal> out;
  for (std::size_t c = 0; c < card.conditions.size(); ++c) {
    const VariableCard& v = card.conditions[c];
    std::set<double> levels;
    for (const auto& r : s.readings) levels.insert(r.conditions[c]);
    const std::string all =
        levels.size() == 1 ? fmt::format(" (all readings are at {})", shown(*levels.begin(), v)) : "";
    const auto at = [&](double value) {
      out.push_back({c, value, Proposal::set, fmt::format("also measure at {} {}{}", v.name, shown(value, v), all)});
    };
    // One value in a formula is a constant of it, such as a time constant, as often as a setting.
    if (levels.size() == 1 && card.name == "expression") continue;
    if (v.name == "direction" || v.name.ends_with("_direction")) {
      if (levels.size() == 1)
        out.push_back({c, 0, Proposal::reverse, fmt::format("also measure with the other {}{}", v.name, all)});
    } else if (v.si_unit == "rad") {
      for (const double turn : {0.5 * std::numbers::pi, std::numbers::pi})
        out.push_back(
            {c, turn, Proposal::add,
             fmt::format("also measure with {} turned by {:.0f} deg", v.name, turn * 180 / std::numbers::pi)});
    } else if (v.name == "time") {
      const double range = *levels.rbegin() - *levels.begin();
      if (range > 0)
        out.push_back({c, range, Proposal::add,
                       fmt::format("repeat the measurement {} later, all else as it was", shown(range, v))});
    } else if (v.si_unit == "K") {
      const double low = *levels.begin(), high = *levels.rbegin(), range = low < high ? high - low : usual_warming;
      for (const double value : {low - range, high + range}) at(value);
    } else if (v.si_unit != "1" && *levels.begin() > 0) {
      for (const double factor : {0.5, 2.0, 4.0}) at(factor * (factor < 1 ? *levels.begin() : *levels.rbegin()));
    }
  }
  return out;
}

/// The scenario with the readings of one block once more, changed.
Scenario with(const Scenario& s, const Observations& o, const Proposal& p) {
  Scenario out = s;
  const std::size_t first = o.sequence.front();
  std::size_t added = 0;
  for (const std::size_t r : o.sequence) {
    if (o.held_out[r] || (!o.blocks.groups.empty() && o.blocks.group[r] != o.blocks.group[first])) continue;
    if (++added > criteria.split_readings) break;
    auto reading = s.readings[r];
    double& x = reading.conditions[p.condition];
    x = p.how == Proposal::set ? p.value : p.how == Proposal::add ? x + p.value : -x;
    out.readings.push_back(reading);
    for (auto& column : out.trace.columns) column.values.push_back(column.values[r]);
    if (!out.trace.order.empty()) out.trace.order.push_back(*std::ranges::max_element(out.trace.order) + 1);
    for (auto& effect : out.stated_effects) {
      std::vector<double> columns;
      for (const auto& column : s.trace.columns) columns.push_back(column.values[r]);
      for (auto& part : effect.parts)
        part.loading.push_back(part.loading_at ? part.loading_at(reading.conditions, columns) : part.loading[r]);
    }
  }
  return out;
}

/// How far apart the members' predictions are in twice the log likelihood, the least of all pairs with the best.
double apart(const TraceContext& c, const Scenario& scenario, const Search& search, const SearchFinding& finding) {
  const propagation::Experiment experiment(scenario);
  const Observations observations = observe(experiment);
  const Simulator simulator(experiment, c.threads);
  std::vector<bool> training = observations.held_out;
  training.flip();
  const std::vector<Index> rows = rows_where(observations, training);
  const Fitter fitter(experiment, simulator, observations, rows, c.threads);
  const JointFit fit = fitter.linearised(search.found.noise);
  if (!fit.valid) return 0;
  std::vector<Term> members{search.found.terms[finding.terms[0]]};
  members.insert(members.end(), finding.rivals.begin(), finding.rivals.end());
  const auto wanted = [&](const Candidate& a) {
    return std::ranges::none_of(members, [&](const Term& t) {
      return t.candidate.name == a.name && t.candidate.shape == a.shape &&
             t.candidate.amplitudes[0].scenario_name == a.amplitudes[0].scenario_name;
    });
  };
  const auto found = physical_candidates(experiment, simulator, fit.at, observations,
                                         criteria.secant_step * fit.design.reference[0], wanted);
  std::vector<const Candidate*> pointers;
  for (const Term& t : members)
    for (const Candidate& a : found)
      if (t.candidate.name == a.name && t.candidate.held == a.held && t.candidate.finite == a.finite) {
        pointers.push_back(&a);
        break;
      }
  if (pointers.size() < 2 || pointers[0]->name != members[0].candidate.name) return 0;
  const Scan scan(fit.design, rows, pointers, c.threads);
  double least = 1e300;
  const Vector signal = pointers[0]->columns * members[0].size;
  const Whitened& w = scan.whitened(scan.plain());
  const double whole = w.squares(w.take(signal))[0];
  for (std::size_t i = 1; i < pointers.size(); ++i) {
    const double cosine = scan.correlation(0, i, scan.plain());
    least = std::min(least, whole * (1 - cosine * cosine));
  }
  return least / search.found.variance;
}

/// "take 3 further readings (cost 16): 2 at feed 8 mm/min; 1 at feed 2 mm/min": the cheapest of those that [plan]
/// allows that distinguishes members of these sizes. Empty: none does.
std::string planned_measurement(const TraceContext& c, const Search& search, const SearchFinding& finding) {
  Scenario s = c.experiment.scenario();
  scenario::Plan asked = *s.plan;
  asked.split.clear();
  asked.detect.clear();
  asked.sizes.clear();
  asked.uncertainties.clear();
  std::vector<Term> members{search.found.terms[finding.terms[0]]};
  members.insert(members.end(), finding.rivals.begin(), finding.rivals.end());
  for (const Term& t : members) {
    const bool whole = t.candidate.family == Family::effect && !t.candidate.in_part();
    const std::string name = whole ? t.candidate.amplitudes[0].scenario_name : t.candidate.name;
    if (std::ranges::find(asked.split, name) != asked.split.end()) return {}; // two shapes of one effect
    asked.split.push_back(name);
    asked.sizes.emplace_back(name, t.size.norm());
  }
  s.plan = std::make_shared<const scenario::Plan>(asked);
  Planned found;
  try {
    found = plan(s, {c.threads});
  } catch (const InputError&) { // a member that the allowed readings do not show
    return {};
  }
  if (!found.met || found.readings.empty()) return {};
  std::string out =
      fmt::format("take {} further reading{} (cost {:.4g})", found.count, found.count == 1 ? "" : "s", found.cost);
  for (std::size_t i = 0; i < found.readings.size() && i < planned_settings; ++i)
    out += fmt::format("{} {} at {}", i == 0 ? ":" : ";", found.readings[i].count, found.readings[i].setting);
  return out + (found.readings.size() > planned_settings ? "; and others, which gumshoe plan lists" : "");
}

} // namespace

std::string splitting_measurement(const TraceContext& c, const Search& search, const SearchFinding& finding) {
  if (finding.terms.empty() || finding.rivals.empty()) return {};
  const Scenario& s = c.experiment.scenario();
  if (s.plan)
    if (std::string planned = planned_measurement(c, search, finding); !planned.empty()) return planned;
  const double now = apart(c, s, search, finding);
  double best = 0;
  std::string words;
  for (const Proposal& p : proposals(*c.experiment.model().card, s)) {
    double d = 0;
    try {
      d = apart(c, with(s, c.observations, p), search, finding);
    } catch (const InputError&) { // impossible there
      continue;
    }
    if (d > best) best = d, words = p.words;
  }
  if (best < criteria.split || best < criteria.split_gain * now) return {};
  return words;
}

} // namespace gumshoe::tracing
