#include "tracing/findings/findings.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/variance_ratio.h"
#include "tracing/criteria.h"
#include "tracing/findings/errors.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/splitting.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/in_place_of_scatter.h"

namespace gumshoe::tracing {
namespace {

const Grouping& replicates(const TraceContext& c, int component) {
  return c.observations.replicate_groups[index(component)];
}

void state_veto(const Search& s, Trace& out) {
  out.statements.push_back("an effect was found in the training data, but it does not improve the prediction of the "
                           "hold-out blocks; nothing is added");
  for (const SearchFinding& one : s.findings)
    if (const Finding& f = one.finding; f.kind != Kind::scatter && f.kind != Kind::not_in_catalogue)
      out.statements.push_back(
          fmt::format("rejected by the hold-out blocks: {} (p = {:.2g})", fmt::join(f.members, ", "), f.p_value));
}

bool scatter_in_class(const Finding& f) {
  return f.kind == Kind::equivalence_class && f.members.back().starts_with("scatter:");
}

/// What a veto leaves of a finding; false if nothing.
bool survives_veto(const TraceContext& c, const Search& s, SearchFinding& found) {
  Finding& f = found.finding;
  // Scatter was found given what is rejected: it counts only if the declared model shows it, too.
  if (f.kind == Kind::scatter) {
    const auto shown = scatter_shown(c, s.base, s.first);
    return shown && shown->component == found.component && look_for_scatter(s.first, c.alpha);
  }
  const bool alone = std::ranges::any_of(s.findings, [&](const SearchFinding& other) {
    return other.finding.kind == Kind::scatter && other.component == found.component;
  });
  const auto left = left_by_veto(f.kind, scatter_in_class(f), alone);
  if (!left) return false;
  if (*left != f.kind) {
    f.kind = *left;
    f.members = {"scatter:" + replicates(c, found.component).name};
    f.depends_on = replicates(c, found.component).labels;
    found.terms.clear();
  }
  return true;
}

/// How to distinguish scatter from one clamping to the next from an effect that looks like it.
std::string split_from_scatter(const Grouping& group, const std::vector<std::string>& depends_on) {
  const auto label = fmt::format("{}", fmt::join(group.labels, " and "));
  if (depends_on == std::vector<std::string>{"time"})
    return fmt::format("repeat the measurement within one {}, after the time that passes until the next one", label);
  return fmt::format("within one {}, vary {} as much as from one to the next", label, fmt::join(depends_on, " and "));
}

/// Share of the declared model's residual that returns when one finding is left out and all others are fitted again:
/// mean squares of the residuals themselves, because noise that is taken to correlate could hide what came back.
double share_of(const TraceContext& c, const Search& s, const SearchFinding& found) {
  const auto mean_square = [&](JointFit fit) {
    fit.design.local = s.found.design.local;
    fit.design.reference = s.found.design.reference;
    const double rms = in_sample(fit, c.fitter.rows(), fit.residual, in_first(c.observations, fit.design)).rms[0];
    return rms * rms;
  };
  std::vector<Term> others;
  for (std::size_t t = 0; t < s.found.terms.size(); ++t)
    if (std::ranges::find(found.terms, t) == found.terms.end()) others.push_back(s.found.terms[t]);
  const double without =
      others.empty() ? mean_square(s.base) : mean_square(c.fitter.fit(others, s.found.noise, &s.found));
  return std::max(0.0, (without - mean_square(s.found)) / mean_square(s.base));
}

/// The same sizes for every member, how much their predictions differ, and how to distinguish them.
void describe_class(const TraceContext& c, const Search& s, const SearchFinding& found, Finding& f) {
  const JointFit& fit = s.found;
  f.alternatives.push_back(f.quantities);
  for (const Term& rival : found.rivals) {
    auto terms = fit.terms;
    terms[found.terms[0]] = rival;
    JointFit with = c.fitter.fit(terms, fit.noise, &fit);
    c.fitter.widen_jumping(with);
    f.alternatives.push_back(sizes(c, with, found.terms[0], found.threshold));
    for (const Index row : c.fitter.rows())
      f.spread += (with.residual[row] - fit.residual[row]) * (with.residual[row] - fit.residual[row]);
  }
  f.spread = std::sqrt(f.spread / static_cast<double>(f.members.size() * c.fitter.rows().size()));
  f.suggestion = splitting_measurement(c, s, found);
  if (scatter_in_class(f)) {
    if (!f.suggestion.empty()) f.suggestion += "; and ";
    f.suggestion += split_from_scatter(replicates(c, found.component), f.depends_on);
  }
  if (f.suggestion.empty()) f.remarks.push_back("no tried change of a condition would distinguish them");
}

/// The fit with the named terms alone; none if there are no shapes.
std::optional<JointFit> without_shapes(const TraceContext& c, const JointFit& fit) {
  std::vector<std::size_t> shapes;
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    if (!fit.terms[t].candidate.physical()) shapes.push_back(t);
  if (shapes.empty() || shapes.size() == fit.terms.size()) return std::nullopt;
  JointFit out = without(c, fit, shapes);
  return out.valid ? std::optional(std::move(out)) : std::nullopt;
}

/// Sizes that the shapes change by more than their standard uncertainty, as they are without them.
void remark_on_shapes(const TraceContext& c, const JointFit& fit, const JointFit& plain, const SearchFinding& found,
                      Finding& f) {
  std::vector<SizedQuantity> other;
  for (const std::size_t t : found.terms) {
    const auto place = std::ranges::count_if(fit.terms.begin(), fit.terms.begin() + index(t),
                                             [](const Term& one) { return one.candidate.physical(); });
    std::ranges::copy(sizes(c, plain, static_cast<std::size_t>(place), found.threshold), std::back_inserter(other));
  }
  for (std::size_t i = 0; i < other.size(); ++i)
    if (const auto& q = f.quantities[i]; std::fabs(other[i].value - q.value) > q.u)
      f.remarks.push_back(fmt::format("{} is {}, u = {}, without the part that has no name", q.name,
                                      shown_size(other[i].value, q.unit, q.si_unit),
                                      shown_size(other[i].u, q.unit, q.si_unit)));
}

} // namespace

namespace {

/// Means that differ by more than their repeats explain: what is read together is off together.
void state_what_repeats_share(const TraceContext& c, const JointFit& fit, Trace& out) {
  const ReadoutScatter& repeats = c.observations.of_readouts;
  const double freedom = static_cast<double>(c.fitter.rows().size()) -
                         static_cast<double>(independent(fit.design, c.fitter.rows()).size());
  if (out.noise.declared || repeats.freedom < criteria.least_pure_freedom || !(repeats.s[0] > 0) || freedom < 1) return;
  const double ratio = std::pow(out.noise.scale / repeats.s[0], 2);
  if (!(p_of_variance_ratio(ratio, freedom, repeats.freedom) < criteria.repeats_share_p)) return;
  const VariableCard& card = c.experiment.model().card->indications[0];
  const auto shown = [&](double x) { return shown_size(x, std::string(card.unit), std::string(card.si_unit)); };
  out.statements.push_back(fmt::format(
      "repeats scatter by only {} about their means, which differ as if a reading had {}: what is read together is off "
      "together; repeats = \"apart\" in readings lets that be traced",
      shown(repeats.s[0]), shown(out.noise.scale)));
}

} // namespace

void describe_noise(const TraceContext& c, const Search& s, Trace& out) {
  const JointFit& fit = s.found;
  Noise& noise = out.noise;
  noise.declared = c.fitter.noise_declared();
  noise.scale = fit.noise * std::sqrt(fit.variance);
  noise.scale *= std::sqrt(c.fitter.mean_variance(0));
  noise.correlation = fit.covariance_model.correlation;
  if (const auto& model = fit.covariance_model; model.scatter >= 0) {
    noise.scatter = replicates(c, model.scatter).name;
    double ratio = model.ratio;
    for (const Component& one : fitted_scatter(c, fit, s.findings).components)
      if (one.index == model.scatter && one.u > 0) ratio = one.u;
    noise.scatter_u = ratio * fit.design.reference[index(std::max(0, model.indication))] * std::sqrt(fit.variance);
  }
  noise.chi_squared_p = s.first.p_noise;
  if (s.last.noise_small && noise.declared)
    out.statements.push_back(
        fmt::format("the noise is smaller than declared ({:.2g} times): its uncertainty is overstated", noise.scale));
  if (noise.correlation >= criteria.reported_correlation)
    out.statements.push_back(fmt::format(
        "the noise of each reading resembles that of the one before (correlation about {:.1f}); this is allowed for",
        noise.correlation));
  state_what_repeats_share(c, fit, out);
}

/// Whether the scenario states no value of the quantity that a term shifts.
bool takes_default(const TraceContext& c, const Term& term) {
  const std::size_t q = term.candidate.amplitudes[0].quantity;
  const auto& all = c.experiment.scenario().quantities;
  return term.candidate.family == Family::declared && q < all.size() &&
         std::ranges::all_of(all[q].entries, [](const auto& entry) { return entry.source == "default"; });
}

void collect(const TraceContext& c, const Search& s, Trace& out) {
  const JointFit& fit = s.found;
  if (out.vetoed)
    state_veto(s, out);
  else
    out.statements.insert(out.statements.end(), s.dropped.begin(), s.dropped.end());
  const auto plain = out.vetoed ? std::nullopt : without_shapes(c, fit);
  const JointFit& stands = out.vetoed ? s.base : fit;
  const FittedScatter scatter = fitted_scatter(c, stands, s.findings);
  for (SearchFinding found : s.findings) {
    if (out.vetoed && !survives_veto(c, s, found)) continue;
    Finding f = found.finding;
    f.removed_share = found.terms.empty() ? 0 : share_of(c, s, found);
    f.name = f.kind == Kind::not_in_catalogue ? "not in the catalogue" : fmt::format("{}", fmt::join(f.members, " | "));
    for (const std::size_t t : found.terms) {
      if (f.kind == Kind::not_in_catalogue) {
        add_curves(c, fit, t, out.rms, f);
        continue;
      }
      const auto more = sizes(c, fit, t, found.threshold);
      f.quantities.insert(f.quantities.end(), more.begin(), more.end());
      remark_on_size(fit.terms[t], f);
      f.by_default = takes_default(c, fit.terms[t]);
    }
    if (plain && !f.quantities.empty()) remark_on_shapes(c, fit, *plain, found, f);
    if (f.kind == Kind::equivalence_class) describe_class(c, s, found, f);
    if (f.kind == Kind::scatter) describe_scatter(c, stands, scatter, found.component, out.rms, f);
    out.findings.push_back(std::move(f));
  }
  out.outcome = out.findings.empty() ? Outcome::nothing_found : Outcome::found;
}

} // namespace gumshoe::tracing
