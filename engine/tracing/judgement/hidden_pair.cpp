#include "tracing/judgement/hidden_pair.h"

#include <algorithm>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

std::optional<std::array<std::size_t, 2>> hidden_pair(const Evidence& e, double best_shape) {
  const auto first = e.best_of([](const Candidate& a) { return a.physical() && !a.in_part(); }, criteria.most_paired);
  if (first.empty()) return std::nullopt;
  std::vector<std::size_t> all = first;
  for (std::size_t b = 0; b < e.candidates().size(); ++b)
    if (e.testable(b) && !e.candidates()[b].in_part() && std::ranges::find(first, b) == first.end()) all.push_back(b);
  const Matrix scores = e.pair_scores(all, first.size());
  double best = 0;
  std::array<std::size_t, 2> pair{};
  for (std::size_t a = 0; a < first.size(); ++a)
    for (std::size_t b = 0; b < all.size(); ++b)
      if (const double s = scores(index(a), index(b));
          s > best && e.candidates()[all[a]].name != e.candidates()[all[b]].name)
        best = s, pair = {all[a], all[b]};
  if (best == 0) return std::nullopt;
  const auto [a, b] = pair;
  const bool found = pair_found(best, {e.score(a), e.score(b)}, {e.limit(a), e.limit(b)}, best_shape);
  return found ? std::optional(pair) : std::nullopt;
}

} // namespace gumshoe::tracing
