#include "tracing/judgement/few_causes.h"

#include <algorithm>

#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/in_place_of_scatter.h"
#include "tracing/judgement/pruning.h"
#include "tracing/judgement/rounds.h"

namespace gumshoe::tracing {

bool groups_scatter(const Search& s) {
  return std::ranges::any_of(
      s.findings, [](const SearchFinding& f) { return f.finding.kind == Kind::scatter && f.component >= 0; });
}

namespace {

/// Whether the noise takes scatter of groups that is no finding: what they are told apart by may be a cause.
bool noise_holds_scatter(const Search& s) { return s.found.valid && s.found.covariance_model.scatter >= 0; }

/// What the findings that are terms had to exceed, in all.
double thresholds(const Search& s) {
  double out = 0;
  for (const SearchFinding& f : s.findings)
    if (!f.terms.empty()) out += f.threshold;
  return out;
}

} // namespace

std::optional<Search> few_causes(const TraceContext& c, const Search& all) {
  if (!groups_scatter(all) && !noise_holds_scatter(all)) return std::nullopt;
  const Fitter plain = c.fitter.without_scatter();
  const TraceContext without{c.experiment,    c.simulator, c.observations, plain,     c.alpha,
                             c.alpha_further, c.draws,     c.seed,         c.threads, c.progress};
  Search out = search_in_rounds(without);
  if (!out.found.valid || out.capped || out.found.terms.empty()) return std::nullopt;
  fit_all_anew(c, all.base, out);
  const TraceContext more = further(c);
  out.last = Evidence(more, out.found, out.findings.size(), {}).assessment();
  if (look_for_scatter(out.last, more.alpha)) return std::nullopt;
  const double lead = criterion_without_terms(c, all.found) - criterion_without_terms(c, out.found);
  if (!(lead > thresholds(out) - thresholds(all))) return std::nullopt;
  out.first = all.first;
  out.ranking = all.ranking;
  out.limits = all.limits;
  out.tried = all.tried;
  return out;
}

} // namespace gumshoe::tracing
