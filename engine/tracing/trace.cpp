#include "tracing/trace.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "quantities/effect_of.h"
#include "scenario/document.h"
#include "tracing/campaigns/scores.h"
#include "tracing/candidates/extended_scenario.h"
#include "tracing/criteria.h"
#include "tracing/findings/comparison.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/offsets.h"
#include "tracing/findings/sizes.h"
#include "tracing/fit/jumping_unknowns.h"
#include "tracing/fit/starting_values.h"
#include "tracing/judgement/few_causes.h"
#include "tracing/judgement/holdout.h"
#include "tracing/judgement/rounds.h"
#include "tracing/judgement/search.h"
#include "tracing/judgement/shape_order.h"
#include "tracing/scenario_out/composition.h"

namespace gumshoe::tracing {
namespace {

/// Whether a key or a text of the document is this name; comments are not read.
bool speaks_of(const scenario::Node& node, std::string_view name) {
  return node.text == name ||
         std::ranges::any_of(node.items, [&](const auto& item) { return speaks_of(item, name); }) ||
         std::ranges::any_of(node.members, [&](const auto& m) { return m.key == name || speaks_of(m.value, name); });
}

/// Readings that were recorded each with its time, or its temperature, and are judged by their means.
void state_what_means_hide(const Observations& o, const scenario::Scenario& s, Trace& out) {
  std::size_t rows = 0;
  for (const auto& r : s.readings) rows += static_cast<std::size_t>(r.repeats);
  std::vector<std::string> recorded;
  for (const Covariate& x : o.covariates)
    if (!x.commanded && x.name != "order") recorded.push_back(x.name);
  if (rows == s.readings.size() || recorded.empty()) return;
  out.statements.push_back(
      fmt::format("{} readings of equal labels and conditions are judged as {}, their means, whatever {} "
                  "did meanwhile; repeats = \"apart\" in readings keeps them apart",
                  rows, s.readings.size(), fmt::join(recorded, " and ")));
}

/// Conditions that only rise, or only fall, from the first reading to the last: what depends on one may depend on the
/// time.
void state_what_goes_with_order(const Observations& o, Trace& out) {
  const auto course = std::ranges::find_if(o.covariates, &Covariate::course);
  if (course == o.covariates.end()) return;
  for (const Covariate& x : o.covariates) {
    if (!x.commanded || x.course) continue;
    std::vector<double> met;
    for (const std::size_t r : o.sequence) met.push_back(x.value[r]);
    const bool rises = std::ranges::is_sorted(met);
    if (!rises && !std::ranges::is_sorted(met, std::ranges::greater{})) continue;
    out.statements.push_back(fmt::format("{} never {} from one reading to the next; what depends on {} cannot be "
                                         "distinguished from what depends on {}",
                                         x.name, rises ? "falls" : "rises", course->name, x.name));
  }
}

/// Says what the design of the data rules out, whatever the readings are.
void state_what_design_rules_out(const TraceContext& c, const scenario::Scenario& s, Trace& out) {
  const ModelCard& card = *c.experiment.model().card;
  const scenario::Node document = scenario::parse_document(s.text, s.file);
  out.statements.insert(out.statements.end(), c.observations.statements.begin(), c.observations.statements.end());
  for (std::size_t i = 0; i < card.conditions.size() && s.readings.size() > 1; ++i) {
    const double first = s.readings.front().conditions[i];
    if (!std::ranges::all_of(s.readings, [&](const auto& r) { return r.conditions[i] == first; })) continue;
    // One that nobody spoke of is not missed.
    if (first == card.conditions[i].default_value && !speaks_of(document, card.conditions[i].name)) continue;
    const std::string unit(card.conditions[i].unit);
    out.statements.push_back(
        fmt::format("{} is {:.6g}{} in every reading; an effect that grows with it cannot be distinguished from a "
                    "constant",
                    card.conditions[i].name, units::from_si(first, unit, std::string(card.conditions[i].si_unit)),
                    units::suffix(unit)));
  }
  state_what_goes_with_order(c.observations, out);
  state_what_means_hide(c.observations, s, out);
}

/// Whether the readings suffice to judge residuals; says why not.
bool enough(const TraceContext& c, Trace& out) {
  const auto& rows = c.fitter.rows();
  const JointFit fit = c.fitter.fit({}, 1);
  if (!fit.valid) {
    out.statements.push_back("the declared model has no value at some of these readings; nothing can be judged");
    out.outcome = Outcome::insufficient_data;
    return false;
  }
  const std::size_t unknowns = independent(fit.design, rows).size();
  if (rows.size() < unknowns + criteria.readings_above_unknowns) {
    const auto& readings = c.experiment.scenario().readings;
    const bool repeated = std::ranges::any_of(readings, [](const auto& r) { return r.repeats > 1; });
    out.statements.push_back(fmt::format(
        "{} readings{} determine {} unknowns; at least four more readings than unknowns are needed to "
        "judge the residuals",
        rows.size(), repeated ? " (readings with equal labels and conditions count as one)" : "", unknowns));
    out.outcome = Outcome::insufficient_data;
    return false;
  }
  const Vector residual = fit.residual(rows);
  if (!residual.allFinite()) {
    out.statements.push_back("the declared model has no finite residuals at these readings; nothing can be judged");
    out.outcome = Outcome::insufficient_data;
    return false;
  }
  const double size = std::fabs(*std::ranges::max_element(
      c.observations.measured, [](double a, double b) { return std::fabs(a) < std::fabs(b); }));
  if (residual.cwiseAbs().maxCoeff() > criteria.exact * size) return true;
  out.statements.push_back("the readings agree with the model to their last digit; they do not scatter, and nothing "
                           "can be distinguished from chance (is the display step too coarse, or are rows copied?)");
  out.outcome = Outcome::insufficient_data;
  return false;
}

bool has_lasting_step(const TraceContext& c, const Search& s) {
  return std::ranges::any_of(s.found.terms,
                             [&](const Term& t) { return is_lasting_step(t.candidate, c.observations); });
}

/// Where the hold-out blocks reject a step that lasts, one block may differ: the search with that, if they do not
/// reject it as well.
bool settled_on_one_block(const TraceContext& c, const Trace& start, Search& found, Trace& out) {
  if (!has_lasting_step(c, found)) return false;
  Search other = search_in_rounds(c, {.steps_last = false});
  Trace judged = start;
  if (has_lasting_step(c, other) || other.findings.empty() || compare(c, other, judged)) return false;
  judged.statements.emplace_back("a step that lasts explains the training data as well; the hold-out blocks reject it");
  found = std::move(other);
  out = std::move(judged);
  return true;
}

/// Compares before and after. If the hold-out blocks veto, all that was found in the last round is dropped, and they
/// judge the rest anew. A rejected name gives way to what the readings show without it.
void judge_by_holdout(const TraceContext& c, Search& found, Trace& out) {
  const Trace start = out;
  std::vector<std::string> rejected;
  out.vetoed = compare(c, found, out) && !settled_on_one_block(c, start, found, out);
  for (; out.vetoed && found.stages.size() > 1; out.vetoed = compare(c, found, out)) {
    const auto dropped = step_back(c, found);
    rejected.insert(rejected.begin(), dropped.begin(), dropped.end());
    out = start;
  }
  std::string name;
  if (out.vetoed)
    if (auto shape = described(c, found)) {
      name = fmt::format("{}", fmt::join(found.findings[0].finding.members, " | "));
      found = std::move(*shape);
      out = start;
      out.vetoed = compare(c, found, out);
    }
  if (!name.empty())
    out.statements.push_back(
        fmt::format("named first and rejected by the hold-out blocks: {}; what is there is described instead", name));
  for (const std::string& later : rejected)
    out.statements.push_back(fmt::format("found after the others and rejected by the hold-out blocks: {}", later));
}

/// Judges a search. Where groups of readings seem to scatter, a few causes may be all of it: they are found instead if
/// they leave no more of the hold-out blocks than noise alone gives, and less than scatter would seldom let them.
void judge(const TraceContext& c, Search& found, Trace& out) {
  const Trace start = out;
  std::optional<Search> few = few_causes(c, found);
  judge_by_holdout(c, found, out);
  if (!few) return;
  Trace judged = start;
  judge_by_holdout(c, *few, judged);
  // Scatter that is no finding may be chance: there held-out readings need only be predicted better.
  const double left = judged.rms.holdout_after,
               most = groups_scatter(found) ? out.rms.holdout_noise_low : out.rms.holdout_after;
  if (judged.vetoed || left > judged.rms.holdout_noise_high || left > most) return;
  found = std::move(*few);
  out = std::move(judged);
}

/// The search without what was rejected. The errors and the noise told are then those of what stands.
Search what_stands(const TraceContext& c, const Search& found, Trace& out) {
  if (!out.vetoed) return found;
  Search left = without_findings(c, found);
  Trace stands;
  stands.rms.unit = out.rms.unit;
  stands.rms.si_unit = out.rms.si_unit;
  compare(c, left, stands);
  out.rms = std::move(stands.rms);
  out.rows = std::move(stands.rows);
  out.outliers = std::move(stands.outliers);
  out.noise.outliers = stands.noise.outliers;
  return left;
}

/// Whether more than noise is left where readings jump with a size. Scatter of single readings is what is left, too.
bool jumps_not_crossed(const TraceContext& c, const Search& found, bool vetoed) {
  if (found.jumping.empty() || vetoed || found.last.p_anything > c.alpha_given(!found.findings.empty())) return false;
  return std::ranges::none_of(found.findings, [](const SearchFinding& f) {
    return f.finding.kind == Kind::scatter && f.finding.depends_on != std::vector<std::string>{"reading"};
  });
}

} // namespace

const char* name(Kind kind) {
  switch (kind) {
  case Kind::named:
    return "named";
  case Kind::equivalence_class:
    return "class";
  case Kind::scatter:
    return "scatter";
  case Kind::not_in_catalogue:
    return "not_in_catalogue";
  }
  return "";
}

namespace {

/// Whether the scenario is what a trace of these readings found: this search is one after it.
bool found_before(const scenario::Scenario& s) {
  const auto size = [](const std::string& name) { return !quantities::effect_of(name).empty(); };
  return s.data.empty() && (std::ranges::any_of(s.trace.free, size) ||
                            std::ranges::any_of(s.trace.priors, &quantities::InputQuantity::estimated));
}

/// Estimated sizes that were sought, because readings jump with them: `gumshoe estimate` does not find these.
void state_sizes_sought(const scenario::Scenario& scenario, Trace& out) {
  for (const calibration::Parameter& p : out.estimate.parameters) {
    const quantities::InputQuantity& q = out.extended.quantities[p.unknown.quantity];
    const bool jumps = std::ranges::find(scenario.trace.jumping, q.name, &std::pair<std::string, double>::first) !=
                       scenario.trace.jumping.end();
    if (jumps && !fitted_before(scenario.trace, q.name))
      out.statements.push_back(fmt::format("estimated where readings jump with it: {} = {}", q.name,
                                           with_u(p.value, p.standard_uncertainty, q.unit, q.si_unit)));
  }
}

/// What the model itself takes up, a reversal or a slope: an error of that shape is no finding, however large.
void state_model_fit(const scenario::Scenario& scenario, Trace& out) {
  constexpr std::size_t most = 6;
  std::vector<std::string> fitted;
  bool shapes = false; // more than what is added to every reading
  for (const calibration::Parameter& p : out.estimate.parameters) {
    if (p.unknown.quantity >= scenario.quantities.size() || !std::isfinite(p.standard_uncertainty)) continue;
    const quantities::InputQuantity& q = scenario.quantities[p.unknown.quantity];
    if (!q.estimated || q.entries.size() != 1 || !quantities::effect_of(q.name).empty()) continue;
    shapes |= !q.name.ends_with("offset");
    const std::string unit = display_unit(out.rms, q.unit, q.si_unit);
    const double u = units::from_si(p.standard_uncertainty, unit, q.si_unit, units::Kind::difference);
    const int decimals = analysis::decimals_for(u);
    fitted.push_back(fmt::format(
        "{} = {}{}, u = {}{}", q.name, analysis::fixed(units::from_si(p.value, unit, q.si_unit), decimals),
        units::suffix(unit), analysis::fixed(u, decimals), units::suffix(units::difference_unit(unit, q.si_unit))));
  }
  if (!shapes) return;
  const std::size_t more = fitted.size() - std::min(most, fitted.size());
  fitted.resize(fitted.size() - more);
  out.statements.push_back(fmt::format("fitted with the model, so that it is in no finding: {}{}",
                                       fmt::join(fitted, "; "), more > 0 ? fmt::format("; and {} more", more) : ""));
}

/// @param converged whether the fit of the declared model did
Trace traced(const scenario::Scenario& scenario, const Settings& settings, bool& converged) {
  Trace out;
  out.extended = extended(scenario);
  const propagation::Experiment experiment(out.extended);
  const auto& model = experiment.model();
  if (!model.simulate_gradient && !(model.kernels && model.kernels() && model.kernels()->simulate))
    calibration::refuse(scenario.file,
                        fmt::format("model {}: the model cannot simulate its indications", scenario.model),
                        "residuals are measured minus simulated indications",
                        scenario.made ? "add [model.indications] with a formula for each" : "");
  const Observations observations = observe(experiment);
  const Simulator simulator(experiment, settings.threads);
  std::vector<bool> training = observations.held_out;
  training.flip();
  Fitter fitter(experiment, simulator, observations, rows_where(observations, training), settings.threads);
  fitter.start_from(scenario);
  if (const auto nearer = with_jumping_found(scenario, experiment, simulator, observations, fitter, settings.threads))
    return traced(*nearer, settings, converged);
  const double further_alpha = criteria.further_share * scenario.trace.alpha;
  const TraceContext c{experiment,
                       simulator,
                       observations,
                       fitter,
                       found_before(scenario) ? further_alpha : scenario.trace.alpha,
                       further_alpha,
                       scenario.trace.draws,
                       scenario.trace.seed,
                       settings.threads,
                       settings.progress};
  out.rms.unit = model.card->indications[0].unit;
  out.rms.si_unit = model.card->indications[0].si_unit;
  if (!observations.one_kind)
    out.statements.push_back(
        fmt::format("root mean squares are in the unit of {}: residuals of other indications count by "
                    "their noise",
                    observations.names[0]));
  out.alpha = c.alpha;
  out.draws = c.draws;
  state_what_design_rules_out(c, scenario, out);
  if (!enough(c, out)) {
    summarise(out);
    return out;
  }
  Search found = search(c);
  if (fitter.weigh_by_label(found.found)) found = search(c);
  converged = found.base.converged;
  if (settings.scores) out.campaign = scores_of(c, found.base);
  out.tried = found.tried;
  out.p_anything = found.first.p_anything;
  out.candidates = found.ranking;
  out.detection_limits = found.limits;
  if (!found.base.converged)
    out.statements.push_back("the fit of the declared model did not converge; none of the figures is reliable");
  if (found.base.kink)
    out.statements.push_back(
        "the model has a kink at the point of linearisation; its derivatives hold for one side only");
  judge(c, found, out);
  if (found.capped)
    out.statements.push_back(
        fmt::format("the search ended at its limit of {} findings; more would be found", criteria.most_findings));
  out.capped = found.capped;
  out.jumps_not_crossed = jumps_not_crossed(c, found, out.vetoed);
  if (out.jumps_not_crossed)
    out.statements.push_back(fmt::format(
        "readings jump with some sizes, of which the search may not have found the best; nearest to the readings: {}",
        fmt::join(found.jumping, ", ")));
  if (!found.impossible.empty() && found.last.p_anything <= c.alpha_given(!found.findings.empty()))
    out.statements.push_back(fmt::format("with sizes beyond what is possible, these would explain what is left: {}",
                                         fmt::join(found.impossible, ", ")));
  const Search stands = what_stands(c, found, out);
  describe_repeats(c, found, out);
  describe_alignments(c, found, out);
  describe_noise(c, stands, out);
  collect(c, found, out);
  if (!std::isfinite(out.p_anything)) {
    out.statements.push_back("the p-value of the search is not a finite number; nothing can be judged");
    out.outcome = Outcome::insufficient_data;
  }
  compose(c, stands, out);
  state_sizes_sought(scenario, out);
  state_model_fit(scenario, out);
  std::ranges::move(fitted_by_label(out), std::back_inserter(out.statements));
  summarise(out);
  return out;
}

} // namespace

Trace trace(const scenario::Scenario& scenario, const Settings& settings) {
  bool converged = true;
  Trace out = traced(scenario, settings, converged);
  if (converged) return out;
  // The stated values may be too far away for the search's steps: a tracker whose place nobody knows.
  const auto nearer = at_estimates(scenario, settings.threads);
  return nearer ? traced(*nearer, settings, converged) : out;
}

} // namespace gumshoe::tracing
