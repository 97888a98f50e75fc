#include "tracing/judgement/search.h"

#include <algorithm>

#include "tracing/judgement/rounds.h"
#include "tracing/judgement/set_aside.h"

namespace gumshoe::tracing {
namespace {

/// Whether single readings scatter more than declared, with all else that was found.
bool larger_noise(const Search& s) {
  return std::ranges::any_of(s.findings,
                             [](const SearchFinding& f) { return f.finding.kind == Kind::scatter && f.component < 0; });
}

/// The search without a few outlying readings, if these make noise look larger, and hide what else is there.
std::optional<Search> with_some_set_aside(const TraceContext& c, const Search& all) {
  const std::vector<Index> rows = outlying_rows(c, all.found);
  if (rows.empty()) return std::nullopt;
  const Fitter others = c.fitter.without_rows(rows);
  const TraceContext without{c.experiment,    c.simulator, c.observations, others,    c.alpha,
                             c.alpha_further, c.draws,     c.seed,         c.threads, c.progress};
  Search found = search_in_rounds(without);
  if (!found.found.valid || larger_noise(found)) return std::nullopt;
  return with_all_readings(c, all, std::move(found), rows.size() / c.observations.indications);
}

} // namespace

Search search(const TraceContext& c) {
  Search all = search_in_rounds(c, {.shapes_for_noise = false});
  if (!larger_noise(all)) return all;
  if (auto without = with_some_set_aside(c, all)) return std::move(*without);
  return search_in_rounds(c);
}

std::optional<Search> described(const TraceContext& context, const Search& rejected) {
  const auto name = [](const SearchFinding& f) {
    return f.finding.kind == Kind::named || f.finding.kind == Kind::equivalence_class;
  };
  if (rejected.findings.size() != 1 || !name(rejected.findings[0])) return std::nullopt;
  Search out = search_in_rounds(context, {.names = false});
  if (out.findings.empty() || out.findings[0].finding.kind != Kind::not_in_catalogue) return std::nullopt;
  out.first = rejected.first;
  out.ranking = rejected.ranking;
  for (RankedCandidate& one : out.ranking)
    if (std::ranges::count(rejected.findings[0].finding.members, one.name) > 0 &&
        (one.outcome == alone || one.outcome == in_class))
      one.outcome = "rejected by the hold-out blocks";
  out.limits = rejected.limits;
  out.tried = rejected.tried;
  return out;
}

} // namespace gumshoe::tracing
