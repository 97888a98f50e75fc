#include "tracing/judgement/decisions.h"

#include <algorithm>
#include <map>
#include <set>

#include "tracing/criteria.h"

namespace gumshoe::tracing {

bool look_for_signature(const Assessment& a, double alpha) { return a.p_anything <= alpha && a.p_signature <= alpha; }

bool look_for_scatter(const Assessment& a, double alpha) { return a.p_anything <= alpha; }

bool search_goes_on(bool took_one, std::size_t findings) { return took_one && findings < criteria.most_findings; }

std::vector<std::size_t> best_of(const std::vector<Scored>& candidates, std::size_t most) {
  std::vector<std::size_t> order, out;
  for (std::size_t a = 0; a < candidates.size(); ++a)
    if (candidates[a].eligible) order.push_back(a);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return candidates[a].score > candidates[b].score; });
  std::set<std::string> names;
  for (const std::size_t a : order) {
    if (out.size() == most) break;
    if (names.insert(candidates[a].name).second) out.push_back(a);
  }
  return out;
}

std::vector<std::size_t> explain_scatter(const std::vector<Scored>& candidates, double gain_of_scatter) {
  std::map<std::string, std::size_t> best;
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    if (!candidates[a].eligible || !(candidates[a].score >= gain_of_scatter)) continue;
    const auto [known, first] = best.try_emplace(candidates[a].name, a);
    if (!first && candidates[a].score > candidates[known->second].score) known->second = a;
  }
  std::vector<std::size_t> out;
  for (const auto& [name, a] : best) out.push_back(a);
  std::ranges::sort(out, [&](std::size_t a, std::size_t b) { return candidates[a].score > candidates[b].score; });
  return out;
}

bool could_still_win(double score, double best) {
  return score >= criteria.contender_share * best - criteria.contender_margin;
}

bool still_counts(double gain, double limit) { return gain > limit - criteria.decisive; }

bool passes(double p, double threshold, double ratio, double limit) { return p <= threshold || ratio > limit; }

bool shape_excludes(double lead, const Chance& chance) {
  return lead > criteria.equal_merit && (lead > criteria.beyond_doubt || chance() < criteria.shape_lead_p);
}

Standing standing(double lead, double correlation, const Chance& chance, const std::function<double()>& added,
                  double limit) {
  const bool decided = lead > criteria.decisive;
  if (correlation > criteria.alike && !decided) return Standing::member; // by the whole model, too
  if (lead > criteria.beyond_doubt || (decided && chance() < criteria.rival_lead_p)) return Standing::excluded;
  return added() > limit ? Standing::separate : Standing::member;
}

bool excludes_scatter(double lead, const Chance& chance) {
  return lead > criteria.decisive && chance() < criteria.rival_lead_p;
}

bool pair_found(double pair, const double (&scores)[2], const double (&limits)[2], double best_shape) {
  return pair > best_shape + criteria.decisive && pair - scores[1] >= limits[0] && pair - scores[0] >= limits[1];
}

bool counts_beside(double both, const double (&scores)[2], double added, const double (&limits)[2], double whole) {
  return both > whole - criteria.equal_merit && added > limits[0] && both - scores[0] > limits[1];
}

bool explains_both(double lead) { return lead > 0; }

std::optional<std::size_t> scatter_found(const Assessment& a, double alpha) {
  for (std::size_t c = 0; c < a.p_component.size(); ++c)
    if (a.data.scatter(index(c), 0) == a.data.scatter.col(0).maxCoeff() && a.p_component[c] <= alpha) return c;
  return std::nullopt;
}

bool larger_noise_found(const Assessment& a, double alpha) {
  return a.p_noise_overall <= alpha && a.p_signature > alpha && a.p_lack_of_fit > alpha &&
         std::ranges::none_of(a.p_block, [&](double p) { return p <= alpha; }) &&
         std::ranges::none_of(a.p_component, [&](double p) { return p <= alpha; });
}

Holdout judge_holdout(const HoldoutError& before, const HoldoutError& after, const Overstated& overstated,
                      double noise_high, const std::function<double()>& beyond) {
  if (after.whitened < before.whitened && after.rms <= criteria.veto_growth * before.rms)
    return before.whitened - after.whitened > criteria.decisive ? Holdout::confirms : Holdout::favours;
  const bool beyond_noise = after.rms >= before.rms && after.rms > noise_high;
  if (!(overstated.plain > criteria.overstated || beyond_noise)) return Holdout::unsure;
  const bool by_chance = std::max(overstated.plain, overstated.weighted) <= criteria.overstated_surely &&
                         beyond() - (after.whitened - before.whitened) > criteria.outweighs;
  return by_chance ? Holdout::outweighed : Holdout::vetoes;
}

std::optional<Kind> left_by_veto(Kind kind, bool scatter_in_class, bool scatter_found_alone) {
  if (kind == Kind::equivalence_class && scatter_in_class && !scatter_found_alone) return Kind::scatter;
  if (kind == Kind::named || kind == Kind::equivalence_class) return std::nullopt;
  return kind;
}

std::string refusal(double identifiable, const std::string& absorbed_by, double p, double threshold) {
  if (identifiable <= criteria.absorbed_share)
    return "not testable: absorbed by " + (absorbed_by.empty() ? std::string("the fit") : absorbed_by);
  return p > threshold ? "refused: no more than chance" : "refused: another candidate explains the residuals better";
}

} // namespace gumshoe::tracing
