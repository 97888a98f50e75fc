#include "tracing/judgement/in_place_of_scatter.h"

#include <algorithm>
#include <array>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/without_scatter.h"

namespace gumshoe::tracing {
namespace {

/// Whether a label says the same of all readings of a group: all of a run are by one operator.
bool one_value_each(const Grouping& label, const Grouping& group) {
  std::vector<std::size_t> value(group.groups.size(), label.groups.size());
  for (std::size_t r = 0; r < group.group.size(); ++r) {
    std::size_t& known = value[group.group[r]];
    if (known != label.groups.size() && known != label.group[r]) return false;
    known = label.group[r];
  }
  return true;
}

/// One group that differs, or one pass of it, or all groups of one operator, always or for a while; a straight line in
/// what was recorded, a step, a pulse, a drift or any course in time: shapes that scatter may look like.
bool is_plain(const Candidate& a, const Grouping& group, const Observations& o) {
  const std::string name = without_indication(a.name, o);
  const auto is_of = [&](const Grouping& label) {
    const auto& pass = a.amplitudes[0].labels;
    return std::ranges::find(label.groups, name.substr(5)) != label.groups.end() ||
           (pass.size() == 1 && pass[0].first == label.name);
  };
  if ((name.starts_with("step:") || name.starts_with("while:") || name.starts_with("bend:")) &&
      std::ranges::any_of(o.labels,
                          [&](const Grouping& label) { return is_of(label) && one_value_each(label, group); }))
    return true;
  if (a.physical() || a.depends_on.size() != 1) return false;
  const auto x = std::ranges::find(o.covariates, a.depends_on[0], &Covariate::name);
  if (x == o.covariates.end()) return false;
  if (x->course)
    return a.family == Family::omnibus || (name == "polynomial:" + x->name && a.shape.empty()) ||
           std::ranges::any_of(std::array{"step:", "while:", "bend:", "pulse:", "shift:", "drift:", "wave:"},
                               [&](const char* kind) { return name.starts_with(kind); });
  return !x->commanded && name == "polynomial:" + x->name && a.shape.empty();
}

/// Size of what a fit leaves, in units of the declared noise, as if no reading resembled another.
double independent_noise(const TraceContext& c, const JointFit& fit) {
  const auto use = independent(fit.design, c.fitter.rows());
  const Whitened plain(fit.design, c.fitter.rows(), use, {});
  const Matrix left = plain.left_over(plain.winsorised(plain.take(fit.residual)));
  return fit.noise * std::sqrt(left.squaredNorm() / static_cast<double>(plain.degrees_of_freedom()));
}

/// Whether a noise, in units of the declared one, is surely larger than that.
bool larger_than_declared(const TraceContext& c, const JointFit& fit, double noise) {
  const double freedom = static_cast<double>(c.fitter.rows().size()) - static_cast<double>(fit.design.fixed.cols());
  return noise * (1 - 2 / std::sqrt(2 * freedom)) > 1;
}

} // namespace

bool scatters_as_declared(const TraceContext& c, const JointFit& fit) {
  return !larger_than_declared(c, fit, independent_noise(c, fit));
}

std::optional<SearchFinding> scatter_shown(const TraceContext& c, const JointFit& fit, const Assessment& a) {
  SearchFinding found;
  found.finding.kind = Kind::scatter;
  if (const auto component = scatter_found(a, c.alpha)) {
    const Grouping& group = c.observations.replicate_groups[*component];
    found.component = static_cast<int>(*component);
    found.finding.p_value = a.p_component[*component];
    found.finding.depends_on = group.labels;
    found.finding.members = {"scatter:" + group.name};
    return found;
  }
  // Noise of single readings, correlation and components apart: that is what would be declared.
  if (!larger_than_declared(c, fit, fit.noise * std::sqrt(a.data.variance[0])) || !larger_noise_found(a, c.alpha))
    return std::nullopt;
  found.finding.p_value = a.p_noise_overall;
  found.finding.depends_on = {"reading"};
  found.finding.members = {"scatter:reading"};
  return found;
}

InPlaceOfScatter in_place_of_scatter(const TraceContext& c, const Evidence& e, const SearchFinding& scatter) {
  const WithoutScatter without(c, e);
  const auto component = index(scatter.component);
  const auto plain = [&](std::size_t a) {
    return is_plain(e.candidates()[a], c.observations.replicate_groups[component], c.observations);
  };
  std::vector<Scored> all;
  std::vector<std::size_t> eligible, effects;
  for (std::size_t a = 0; a < e.candidates().size(); ++a) {
    const Candidate& one = e.candidates()[a];
    const bool effect = e.testable(a) && one.family != Family::declared && !one.in_part();
    all.push_back({one.name, without.score(a), effect || plain(a)});
    if (all.back().eligible) eligible.push_back(a);
    if (effect) effects.push_back(a);
  }
  // Scatter of few groups always looks like some shape, and seldom like one of the few effects that are known.
  const auto excluded_by = [&](double lead, const std::vector<std::size_t>& best_of) {
    return excludes_scatter(lead, [&] { return without.chance_of_lead(best_of, component, lead); });
  };
  InPlaceOfScatter out;
  out.effects = scatter;
  out.effects.finding.kind = Kind::equivalence_class;
  out.effects.finding.members.clear();
  double lead = 0;
  const double gain = e.assessment().data.scatter(scatter.component, 0);
  const auto rivals = explain_scatter(all, gain);
  for (const std::size_t a : rivals) {
    if (out.shape && all[a].score < all[*out.shape].score - criteria.equal_merit) break;
    const Fit linear = without.fit(a);
    if (plain(a)) {
      if (a != rivals[0]) continue;
      if (!excluded_by(all[a].score - gain, eligible)) {
        out.as_well = a;
        continue;
      }
      out.with_shape = e.with({e.linear_term(a)});
      if (out.with_shape.valid && e.predicts_better(out.with_shape, without.model(linear))) out.shape = a;
      continue;
    }
    const Candidate& effect = e.candidates()[a];
    JointFit fit = e.with({effect.start.empty() ? Term{effect, linear.size} : at_start(effect)});
    if (!fit.valid || !e.predicts_better(fit, without.model(linear))) continue;
    out.members.push_back(a);
    out.effects.finding.members.push_back(e.candidates()[a].name);
    if (out.effects.terms.empty()) {
      out.effects.terms = {e.fit().terms.size()};
      out.effects.threshold = e.limit(a);
      out.effects.finding.depends_on = e.candidates()[a].depends_on;
      out.fit = std::move(fit);
      lead = all[a].score - gain;
    } else {
      out.effects.rivals.push_back(fit.terms.back());
    }
  }
  if (out.effects.terms.empty()) return out;
  if (!excluded_by(lead, effects))
    out.effects.finding.members.push_back(scatter.finding.members[0]);
  else if (out.effects.finding.members.size() == 1)
    out.effects.finding.kind = Kind::named;
  return out;
}

std::optional<Trial> in_place_of_larger_noise(const TraceContext& c, const Evidence& e) {
  std::vector<Scored> all;
  for (std::size_t a = 0; a < e.candidates().size(); ++a)
    all.push_back(
        {e.candidates()[a].name, e.score(a), !e.candidates()[a].physical() && e.assessment().p[a] <= c.alpha});
  std::optional<Trial> out;
  for (const std::size_t a : best_of(all, criteria.most_shapes))
    if (Trial one = e.trial(a);
        one.fit.valid && scatters_as_declared(c, one.fit) && !e.of_few(one.fit) && (!out || one.score > out->score))
      out = std::move(one);
  return out;
}

} // namespace gumshoe::tracing
