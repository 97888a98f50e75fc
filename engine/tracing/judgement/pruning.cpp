#include "tracing/judgement/pruning.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "tracing/judgement/decisions.h"
#include "tracing/judgement/evidence.h"
#include "tracing/judgement/form_tuning.h"
#include "tracing/judgement/in_place_of_names.h"

namespace gumshoe::tracing {
namespace {

/// Removes a finding; the others' terms are those of the fit without its own.
SearchFinding removed(std::vector<SearchFinding>& findings, std::size_t at) {
  SearchFinding gone = std::move(findings[at]);
  findings.erase(findings.begin() + index(at));
  for (SearchFinding& f : findings)
    for (std::size_t& t : f.terms)
      t -= index(std::ranges::count_if(gone.terms, [&](std::size_t other) { return other < t; }));
  return gone;
}

/// @param gains  by finding: the ratio that it adds less the one that it must exceed
bool drop_least(const TraceContext& c, Search& s, const std::vector<double>& gains, std::set<std::string>& dropped) {
  const auto least = std::ranges::min_element(gains);
  if (least == gains.end() || still_counts(*least, 0)) return false;
  const SearchFinding gone = removed(s.findings, static_cast<std::size_t>(least - gains.begin()));
  const std::string name = s.found.terms[gone.terms[0]].candidate.name;
  dropped.insert(name);
  s.dropped.push_back(
      fmt::format("{} was found and then dropped: given the other findings, it no longer counts", name));
  s.found = fitted_anew(c, without(c, s.found, gone.terms));
  return true;
}

/// A member of a class that was found by itself, too, is no longer a name for the class.
void settle_classes(std::vector<SearchFinding>& findings) {
  for (SearchFinding& f : findings) {
    if (f.finding.kind != Kind::equivalence_class) continue;
    auto& members = f.finding.members;
    for (std::size_t i = members.size(); i-- > 1;) {
      const bool known = std::ranges::any_of(findings, [&](const SearchFinding& other) {
        return other.finding.kind == Kind::named && other.finding.members[0] == members[i];
      });
      if (!known) continue;
      if (i <= f.rivals.size()) f.rivals.erase(f.rivals.begin() + index(i) - 1);
      members.erase(members.begin() + index(i));
    }
    if (members.size() == 1) f.finding.kind = Kind::named;
  }
}

/// Neither finding is tried again: the shape explains what they do.
void put_in_place(const TraceContext& c, Search& s, InPlaceOfNames one, std::set<std::string>& dropped) {
  SearchFinding shape;
  shape.finding.kind = Kind::not_in_catalogue;
  shape.finding.p_value = 0;
  shape.finding.depends_on = one.shape.depends_on;
  shape.finding.described_by = one.shape.name;
  shape.finding.remarks = {"described by " + with_shape(one.shape)};
  for (const std::size_t at : {one.named, one.rest}) {
    const SearchFinding& f = s.findings[at];
    shape.threshold += f.threshold;
    shape.finding.p_value = std::max(shape.finding.p_value, f.finding.p_value);
    for (const std::size_t t : f.terms) dropped.insert(s.found.terms[t].candidate.name);
    dropped.insert(f.finding.members.begin(), f.finding.members.end());
    const Candidate& gone = s.found.terms[f.terms[0]].candidate;
    if (gone.name == one.shape.name) continue; // it stands for both, fitted anew
    s.dropped.push_back(
        fmt::format("{} was found and then dropped: {} explains what it explained", gone.name, with_shape(one.shape)));
  }
  for (const std::size_t at : {std::max(one.named, one.rest), std::min(one.named, one.rest)}) removed(s.findings, at);
  dropped.erase(one.shape.name);
  shape.terms = {one.fit.terms.size() - 1};
  s.findings.push_back(std::move(shape));
  s.found = fitted_anew(c, one.fit);
}

} // namespace

JointFit fitted_anew(const TraceContext& c, const JointFit& fit) {
  JointFit again = c.fitter.fit(fit.terms, 0, &fit);
  return with_tuned_forms(c, again.valid ? std::move(again) : fit);
}

void fit_all_anew(const TraceContext& c, const JointFit& base, Search& s) {
  const auto fitted = [&](const JointFit& fit) {
    return fit.terms.empty() ? base : fitted_anew(c, c.fitter.fit(fit.terms, 0));
  };
  s.base = base;
  s.found = fitted(s.found);
  for (Stage& stage : s.stages) stage.fit = fitted(stage.fit);
  c.fitter.widen_jumping(s.found);
}

void prune(const TraceContext& c, Search& s, std::set<std::string>& dropped) {
  while (auto one = in_place_of_names(c, s)) put_in_place(c, s, std::move(*one), dropped);
  std::vector<double> gains;
  do {
    gains.clear();
    for (const SearchFinding& f : s.findings)
      gains.push_back(f.terms.empty() || s.findings.size() == 1
                          ? std::numeric_limits<double>::infinity()
                          : gain_of(c, s.found, f.terms, f.component >= 0) - f.threshold);
  } while (drop_least(c, s, gains, dropped));
  settle_classes(s.findings);
}

} // namespace gumshoe::tracing
