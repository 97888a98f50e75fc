#include "tracing/judgement/trials.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tracing/criteria.h"
#include "tracing/judgement/beside.h"
#include "tracing/judgement/decisions.h"
#include "tracing/judgement/shape_order.h"

namespace gumshoe::tracing {

bool is_significant(const JointFit& fit) {
  const std::size_t last = fit.terms.size() - 1;
  const Term& term = fit.terms[last];
  if (!term.candidate.start.empty()) return true;
  const Vector u = uncertainties(fit, last);
  return (term.size.array().square() > criteria.decisive * u.array().square()).any();
}

std::vector<Trial> physical_trials(const Evidence& evidence, std::vector<Trial>& denied) {
  // What only one rod or one tool has asks for more: it must lead what all have.
  auto physical =
      evidence.best_of([](const Candidate& a) { return a.physical() && !a.in_part(); }, criteria.most_refitted);
  const auto parts = evidence.best_of([](const Candidate& a) { return a.in_part(); }, 1);
  if (!parts.empty() && (physical.empty() || evidence.score(parts[0]) >
                                                 evidence.score(physical[0]) + 2 * std::log(criteria.rarity_of_part)))
    physical = evidence.best_of([](const Candidate& a) { return a.physical(); }, criteria.most_refitted);
  std::vector<Trial> out;
  for (const std::size_t a : physical) {
    if (!out.empty() && !could_still_win(evidence.score(a), evidence.score(physical[0]))) break;
    if (Trial one = evidence.trial(a); one.fit.valid) out.push_back(std::move(one));
  }
  // Those that do not pass by themselves may be members of the class of one that does.
  const Assessment& assessment = evidence.assessment();
  const auto passes_by_signature = [&](const Trial& t) {
    return passes(assessment.p[t.candidate], assessment.threshold, t.ratio, evidence.limit(t.candidate));
  };
  const auto counts = [&](const Trial& t) {
    return passes_by_signature(t) && still_counts(t.ratio, evidence.limit(t.candidate)) && is_significant(t.fit);
  };
  std::ranges::sort(out, std::ranges::greater{}, &Trial::worth);
  const auto best = std::ranges::find_if(out, counts);
  std::copy_if(out.begin(), best, std::back_inserter(denied), passes_by_signature);
  if (best == out.end()) return {};
  std::rotate(out.begin(), best, best + 1);
  return out;
}

std::vector<Trial> shape_trials(const TraceContext& c, const Evidence& evidence, bool steps_last) {
  const Assessment& assessment = evidence.assessment();
  auto shapes = evidence.best_of([](const Candidate& x) { return !x.physical(); }, criteria.most_shapes);
  std::erase_if(shapes, [&](std::size_t a) { return assessment.p[a] > assessment.threshold; });
  // By the whole model: readings that are outlying without a shape need not be so with it.
  std::vector<Trial> tried;
  for (const std::size_t a : shapes)
    if (Trial one = evidence.trial(a); one.fit.valid) tried.push_back(std::move(one));
  if (tried.empty()) return tried;
  // Equal shapes differ by rounding: then as they were made.
  const auto place = [](const Trial& t) { return std::pair{-std::round(t.score * 1e3), t.candidate}; };
  std::ranges::sort(tried, std::ranges::less{}, place);
  order_shapes(c, evidence, tried, steps_last);
  if (const auto simpler = simpler_beside_another(evidence, c.observations, tried[0].candidate))
    if (Trial one = evidence.trial(*simpler); one.fit.valid) tried.insert(tried.begin(), std::move(one));
  return tried;
}

} // namespace gumshoe::tracing
