#include <algorithm>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/in_place_of_scatter.h"
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

Search without_findings(const TraceContext& c, Search search) {
  search.found = search.base;
  c.fitter.widen_jumping(search.found);
  search.findings.clear();
  search.stages.clear();
  search.last = search.first;
  return search;
}

std::vector<std::string> step_back(const TraceContext& c, Search& s) {
  s.stages.pop_back();
  const Stage& left = s.stages.back();
  std::vector<std::string> dropped;
  for (const SearchFinding& f : s.findings) {
    const auto& [kind, name, members] = std::tie(f.finding.kind, f.finding.described_by, f.finding.members);
    const bool known = std::ranges::any_of(left.findings, [&](const SearchFinding& other) {
      return std::tie(other.finding.kind, other.finding.described_by, other.finding.members) ==
             std::tie(kind, name, members);
    });
    if (!known) dropped.push_back(kind == Kind::not_in_catalogue ? name : fmt::format("{}", fmt::join(members, " | ")));
  }
  s.findings = left.findings;
  s.dropped = left.dropped;
  s.found = s.stages.back().fit;
  s.capped = false;
  s.impossible.clear();
  const TraceContext more = further(c);
  s.last = Evidence(more, s.found, s.findings.size(), {}).assessment();
  if (look_for_scatter(s.last, more.alpha))
    if (const auto scatter = scatter_shown(more, s.found, s.last)) s.findings.push_back(*scatter);
  c.fitter.widen_jumping(s.found);
  return dropped;
}

} // namespace gumshoe::tracing
