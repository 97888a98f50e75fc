#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "scenario/analysis.h"
#include "scenario/choose_time.h"
#include "scenario/options.h"
#include "scenario/plan_options.h"
#include "scenario/trace.h"
#include "scenario/volume.h"

namespace gumshoe::scenario {
namespace {

using quantities::Component;
using quantities::Distribution;
using quantities::Entry;
using quantities::InputQuantity;
using quantities::Reading;

using Lines = std::back_insert_iterator<std::string>;

/// "0.005 m (5 mm)"
std::string both(double si, std::string_view unit, std::string_view si_unit) {
  if (unit == "1") return fmt::format("{:.12g}", si);
  if (unit == si_unit) return fmt::format("{:.12g} {}", si, unit);
  const double shown = units::from_si(si, std::string(unit), std::string(si_unit));
  return fmt::format("{:.12g} {} ({:.12g} {})", si, si_unit, shown, unit);
}

/// "rectangular (low -1e-06 m, high 1e-06 m)"
std::string described(const Distribution& d, const std::string& si_unit) {
  using enum quantities::ParameterCard::Dimension;
  const auto card = std::ranges::find(quantities::families(), d.family, &quantities::FamilyCard::family);
  if (d.values) return fmt::format("{} ({} values)", card->name, d.values->size());
  std::string out;
  for (std::size_t i = 0; i < card->parameters.size(); ++i) {
    const auto& p = card->parameters[i];
    out += fmt::format("{}{} {:.6g}{}", out.empty() ? "" : ", ", p.key, d.parameters[i],
                       p.dimension == number || p.dimension == log ? "" : units::suffix(si_unit));
  }
  return fmt::format("{} ({})", card->name, out);
}

void explain(const Component& c, const InputQuantity& q, Lines out) {
  const std::string u = fmt::format("u {:.6g}{}", c.distribution.standard_uncertainty(), units::suffix(q.si_unit));
  fmt::format_to(out, "      {}: {}, {}, Type {}, {}", c.name, described(c.distribution, q.si_unit), u, c.evaluation,
                 c.per.empty() ? "one draw" : fmt::format("one draw per {}", fmt::join(c.per, ", ")));
  if (std::isfinite(c.degrees_of_freedom)) fmt::format_to(out, ", {:.6g} degrees of freedom", c.degrees_of_freedom);
  if (!c.source.empty()) fmt::format_to(out, ", source: {}", c.source);
  fmt::format_to(out, "\n");
}

void explain(const InputQuantity& q, const ModelCard& model, Lines out) {
  const bool noise = std::ranges::find(model.indications, q.name, &VariableCard::name) != model.indications.end();
  for (const Entry& e : q.entries) {
    const std::string labels = e.labels.empty() ? "" : " [" + text_of(e.labels) + "]";
    fmt::format_to(out, "  {}{}{} = {}", noise ? "noise of " : "", q.name, labels, both(e.value, q.unit, q.si_unit));
    if (q.estimated) fmt::format_to(out, ", estimated");
    if (e.source == "default")
      fmt::format_to(out, ", default");
    else if (!e.source.empty() && e.components.empty())
      fmt::format_to(out, ", source: {}", e.source);
    fmt::format_to(out, "{}\n", e.components.empty() ? ", exact" : "");
    for (const Component& c : e.components) explain(c, q, out);
  }
}

void explain(const Scenario& s, std::size_t number, const ModelCard& model, Lines out) {
  const Reading& r = s.readings[number - 1];
  fmt::format_to(out, "  {}{}:", number, r.labels.empty() ? "" : " [" + text_of(r.labels) + "]");
  const auto list = [&](const std::vector<double>& values, std::span<const VariableCard> cards) {
    for (std::size_t i = 0; i < values.size(); ++i)
      fmt::format_to(out, " {} {};", cards[i].name, both(values[i], cards[i].unit, cards[i].si_unit));
  };
  list(r.conditions, model.conditions);
  list(r.indications, model.indications);
  for (const TraceColumn& c : s.trace.columns)
    fmt::format_to(out, " {} {};", c.name, both(c.values[number - 1], c.unit, c.si_unit));
  for (const StatedEffect& e : s.stated_effects)
    for (const StatedPart& part : e.parts)
      fmt::format_to(out, " loading of {} {:.12g} SI;",
                     e.parts.size() == 1 ? e.name
                                         : fmt::format("{} on {}", e.name, model.indications[part.target].name),
                     part.loading[number - 1]);
  fmt::format_to(out, " {}\n", r.repeats == 1 ? "one indication" : fmt::format("mean of {} indications", r.repeats));
}

void explain(const quantities::Correlation& c, Lines out) {
  constexpr std::string_view kinds[] = {"copula", "pearson", "spearman", "multivariate_t"};
  static_assert(std::size(kinds) == static_cast<std::size_t>(quantities::Correlation::Kind::multivariate_t) + 1);
  fmt::format_to(out, "  {} ({}):", fmt::join(c.quantities, ", "), kinds[static_cast<int>(c.kind)]);
  for (std::size_t i = 0; i < c.matrix.size(); ++i)
    fmt::format_to(out, "{}{:.6g}", i && i % c.quantities.size() == 0 ? "; " : " ", c.matrix[i]);
  fmt::format_to(out, "\n");
}

void explain(const ConformityTest& c, const ModelCard& model, Lines out) {
  fmt::format_to(out, "  conformity of {}, SI limits [{}, {}], ", c.measurand,
                 c.lower ? fmt::format("{:.12g}", *c.lower) : "none",
                 c.upper ? fmt::format("{:.12g}", *c.upper) : "none");
  if (c.rule != DecisionRule::stated)
    fmt::format_to(out, "rule {}", name(c.rule));
  else
    fmt::format_to(out, "guard band {}",
                   c.guard_factor != 0 ? fmt::format("{:.6g} U", c.guard_factor)
                                       : fmt::format("{:.12g} SI", c.guard_band));
  const auto card = std::ranges::find(model.measurands, c.measurand, &VariableCard::name);
  if (c.process && card != model.measurands.end())
    fmt::format_to(out, ", process {} + {}", both(c.process_value, card->unit, card->si_unit),
                   described(*c.process, std::string(card->si_unit)));
  fmt::format_to(out, "\n");
}

void explain_options(const Scenario& s, const ModelCard& model, Lines out) {
  fmt::format_to(out, "run\n  {}\n", explained(run_options(), s.run));
  if (s.run.adaptive.rule != StoppingRule::fixed)
    fmt::format_to(out, "  adaptive: {}\n", explained(adaptive_options(), s.run.adaptive));
  fmt::format_to(out, "analysis\n  {}, sensitivity {}\n", explained(analysis_options(), s.analysis),
                 explained_changes(sensitivity_options(), s.analysis.sensitivity));
  for (const OneAtATime& study : s.analysis.one_at_a_time)
    fmt::format_to(out, "  one at a time: {} ({} quantities)\n", printable(study.title), study.steps.size());
  for (const ConformityTest& c : s.analysis.conformity) explain(c, model, out);
  for (const Target& t : s.analysis.targets) {
    fmt::format_to(out, "  target: U of {} at most {:.12g} SI", t.measurand, t.expanded_uncertainty);
    for (const auto& [quantity, cost] : t.costs) fmt::format_to(out, ", cost of {} {:.6g}", quantity, cost);
    fmt::format_to(out, "\n");
  }
  for (const Comparison& c : s.analysis.comparisons)
    fmt::format_to(out, "  compare {} between values of {}{}\n", c.measurand, c.between,
                   c.within.empty() ? "" : ", within " + c.within);
  for (const Printed& p : s.analysis.printed) {
    const auto card = std::ranges::find(model.measurands, p.measurand, &VariableCard::name);
    const std::string labels = p.labels.empty() ? "" : " [" + text_of(p.labels) + "]";
    fmt::format_to(out, "  printed {}{} = {}{}\n", p.measurand, labels,
                   card == model.measurands.end() ? std::string("?") : both(p.value, card->unit, card->si_unit),
                   p.source.empty() ? "" : ", source: " + p.source);
  }
}

void explain(const Choose& c, const ModelCard& model, Lines out) {
  constexpr std::string_view kinds[] = {"condition", "quantity", "number of readings", "evaluation"};
  const auto shown = [&](const Knob& k, double x) {
    return k.kind == Knob::Kind::evaluation ? std::string(model.evaluations[static_cast<std::size_t>(x)].name)
                                            : both(x, k.unit, k.si_unit);
  };
  fmt::format_to(out, "choose\n  U of {} at most {:.12g} SI in the least time, {}, asked of the {}{}\n", c.measurand,
                 c.target, name(c.definition), c.worst_case ? "worst case" : "average",
                 c.bias ? fmt::format("; bias at most {:.12g} SI", *c.bias) : "");
  fmt::format_to(
      out, "  samples {} a candidate, {} to confirm with a probability of {}; refinements {}, near {}, sobol {}\n",
      c.samples, c.confirm_samples, c.confirm_probability, c.refinements, c.near, c.sobol);
  for (const Variable& v : c.variables) {
    fmt::format_to(out, "  {} {}:", kinds[static_cast<int>(v.knob.kind)], v.knob.name);
    if (v.range)
      fmt::format_to(out, " {} to {}, {} steps, {}\n", shown(v.knob, v.values.front()), shown(v.knob, v.values.back()),
                     v.steps, v.logarithmic ? "logarithmic" : "linear");
    else
      for (std::size_t i = 0; i < v.values.size(); ++i)
        fmt::format_to(out, " {}{}", shown(v.knob, v.values[i]), i + 1 < v.values.size() ? "," : "\n");
  }
  const auto settings = [&](const std::vector<Setting>& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      fmt::format_to(out, "{} {} {}", i > 0 ? "," : "", list[i].knob.name, shown(list[i].knob, list[i].value));
    fmt::format_to(out, "\n");
  };
  for (std::size_t e = 0; e < c.time.size(); ++e)
    if (c.time[e]) fmt::format_to(out, "  time of {}: {}\n", model.evaluations[e].name, c.time[e]->text());
  for (const ChooseCase& one : c.cases) fmt::format_to(out, "  case {}:", one.name), settings(one.values);
  for (const ChooseCompare& one : c.compare) fmt::format_to(out, "  compare {}:", one.name), settings(one.settings);
}

void explain(const Volume& v, Lines out) {
  const auto axes = v.chain->card->conditions;
  const auto at = [&](double x, const VariableCard& axis) { return both(x, axis.unit, axis.si_unit); };
  fmt::format_to(out, "volume\n  {} points, {} samples\n", v.points(), v.samples);
  for (const VolumeRange& r : v.ranges)
    fmt::format_to(out, "  {}: {} to {}, {} points\n", axes[r.axis].name, at(r.from, axes[r.axis]),
                   at(r.to, axes[r.axis]), r.points);
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (std::ranges::find(v.ranges, i, &VolumeRange::axis) == v.ranges.end())
      fmt::format_to(out, "  {} {}\n", axes[i].name, at(v.commands[i], axes[i]));
  if (v.tool) fmt::format_to(out, "  tool at {:.12g} m\n", fmt::join(*v.tool, " m, "));
}

void explain(const Plan& p, Lines out) {
  fmt::format_to(out, "plan\n  {} readings are allowed, at most {} are taken{}; power {}, alpha {}\n",
                 p.readings.size(), p.most, p.budget ? fmt::format(", for at most {}", *p.budget) : "", p.power,
                 p.alpha);
  if (!p.split.empty()) fmt::format_to(out, "  split {}\n", fmt::join(p.split, " from "));
  if (!p.detect.empty()) fmt::format_to(out, "  detect {}\n", fmt::join(p.detect, ", "));
  for (const auto& [name, size] : p.sizes) fmt::format_to(out, "  size of {}: {:.12g} SI\n", name, size);
  for (const auto& [name, u] : p.uncertainties) fmt::format_to(out, "  u of {} at most {:.12g} SI\n", name, u);
  if (p.d_optimal()) fmt::format_to(out, "  no goal: D-optimal for the free unknowns\n");
  for (const auto& [label, cost] : p.setup_costs) fmt::format_to(out, "  a new {} costs {}\n", label, cost);
}

void explain(const StatedEffect& e, const ModelCard& model, Lines out) {
  for (const StatedPart& part : e.parts)
    fmt::format_to(out, "  {}: size ({}) * ({}) adds to {}\n", e.name, e.unit, part.formula,
                   part.on_quantity ? model.quantities[part.target].name : model.indications[part.target].name);
  fmt::format_to(out, "    {}{}{}\n", e.freed ? "freed" : "at null", e.meaning.empty() ? "" : ", meaning: " + e.meaning,
                 e.source.empty() ? "" : ", source: " + e.source);
}

void explain(const TraceOptions& t, Lines out) {
  fmt::format_to(out, "trace\n  blocks {}, final {}; order {}\n", t.blocks.empty() ? "none" : t.blocks,
                 t.final_blocks.empty() ? std::string("the last quarter")
                                        : fmt::format("{}", fmt::join(t.final_blocks, ", ")),
                 t.order_name.empty() ? "as the readings stand" : t.order_name);
  if (!t.redone)
    fmt::format_to(out, "  redone: every set of one or two labels with at least six combinations\n");
  else if (t.redone->empty())
    fmt::format_to(out, "  redone: no act\n");
  for (const auto& labels : t.redone.value_or(std::vector<std::vector<std::string>>{}))
    fmt::format_to(out, "  redone: {}\n", fmt::join(labels, " with "));
  fmt::format_to(out, "  {}\n", explained(trace_options(), t));
  for (const TraceColumn& c : t.columns) {
    const auto [low, high] = std::minmax_element(c.values.begin(), c.values.end());
    fmt::format_to(out, "  column {}: {} to {}\n", c.name, both(*low, c.unit, c.si_unit),
                   both(*high, c.unit, c.si_unit));
  }
}

std::string null_effects(const Scenario& s, const ModelCard& model, const Catalogue& catalogue) {
  std::string out;
  for (const EffectCard* effect : catalogue.effects) {
    if (catalogue.applies && !catalogue.applies(model, *effect)) continue;
    const std::string prefix = std::string(effect->name) + '.';
    const bool freed = std::any_of(s.quantities.begin(), s.quantities.end(),
                                   [&](const auto& q) { return q.name.starts_with(prefix); });
    if (!freed) out += (out.empty() ? "" : ", ") + std::string(effect->name);
  }
  return out;
}

} // namespace

std::string explain(const Scenario& s, const Catalogue& catalogue) {
  std::string text;
  const Lines out = std::back_inserter(text);
  fmt::format_to(out, "{} (hash {})\n", s.file, s.hash);
  if (!s.data.empty()) fmt::format_to(out, "readings from {}\n", s.data);
  if (!s.title.empty()) fmt::format_to(out, "title: {}\n", printable(s.title));
  fmt::format_to(out, "model {}, method {}, evaluation {}\n", s.model, name(s.method), s.evaluation);
  const auto known =
      std::find_if(catalogue.models.begin(), catalogue.models.end(), [&](const auto* m) { return m->name == s.model; });
  const ModelCard* const model = s.made ? s.made->card : known == catalogue.models.end() ? nullptr : *known;
  if (!model) return text;
  if (s.made && !model->summary.empty()) fmt::format_to(out, "stated here\n  {}\n", model->summary);
  fmt::format_to(out, "readings\n");
  for (std::size_t i = 0; i < s.readings.size(); ++i) explain(s, i + 1, *model, out);
  fmt::format_to(out, "quantities (SI; a component is a deviation from the value)\n");
  for (const InputQuantity& q : s.quantities) explain(q, *model, out);
  if (!s.correlations.empty()) fmt::format_to(out, "correlations\n");
  for (const auto& c : s.correlations) explain(c, out);
  if (const std::string left = null_effects(s, *model, catalogue); !left.empty())
    fmt::format_to(out, "effects at their null value\n  {}\n", left);
  if (!s.stated_effects.empty()) fmt::format_to(out, "stated effects\n");
  for (const StatedEffect& e : s.stated_effects) explain(e, *model, out);
  explain_options(s, evaluated_card(*model, s.evaluation), out);
  if (s.choose) explain(*s.choose, *model, out);
  if (const auto volume = stated_volume(s)) explain(*volume, out);
  if (s.plan) explain(*s.plan, out);
  if (s.trace.stated) explain(s.trace, out);
  const std::vector<std::string> notes = notes_of_a_run(s);
  if (!notes.empty()) fmt::format_to(out, "notes\n");
  for (const std::string& note : notes) fmt::format_to(out, "  {}\n", note);
  return text;
}

} // namespace gumshoe::scenario
