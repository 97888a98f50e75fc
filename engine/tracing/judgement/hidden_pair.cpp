#include "tracing/judgement/hidden_pair.h"

#include <algorithm>

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {
namespace {

/// Candidates whose pairs are tried: the first of them with all.
struct Tried {
  std::vector<std::size_t> all;
  std::size_t first = 0;
};

Tried tried_in_pairs(const Evidence& e) {
  Tried out{e.best_of([](const Candidate& a) { return a.physical() && !a.in_part(); }, criteria.most_paired)};
  out.first = out.all.size();
  for (std::size_t b = 0; b < e.candidates().size() && out.first > 0; ++b) {
    const bool known =
        std::ranges::find(out.all.begin(), out.all.begin() + index(out.first), b) != out.all.begin() + index(out.first);
    if (e.testable(b) && !e.candidates()[b].in_part() && !known) out.all.push_back(b);
  }
  return out;
}

/// The two that explain most together.
struct Pair {
  std::size_t a = 0, b = 0;
  double score = 0;

  /// By how much each exceeds, given the other, what it must: the lesser of the two. `alone`: their scores.
  double excess(const Evidence& e, double alone_a, double alone_b) const {
    return std::min(score - alone_b - e.limit(a), score - alone_a - e.limit(b));
  }
};

Pair best_pair(const Evidence& e, const Tried& tried, const Matrix& scores) {
  Pair best;
  for (std::size_t a = 0; a < tried.first; ++a)
    for (std::size_t b = 0; b < tried.all.size(); ++b)
      if (const double s = scores(index(a), index(b));
          s > best.score && e.candidates()[tried.all[a]].name != e.candidates()[tried.all[b]].name)
        best = {tried.all[a], tried.all[b], s};
  return best;
}

/// Probability that the best pair of noise alone exceeds by as much.
double chance_of_pair(const Evidence& e, const Tried& tried, double excess) {
  const Evidence::ScoresOfNoise noise = e.scores_of_noise(tried.all, tried.first);
  std::size_t as_much = 0;
  for (std::size_t k = 0; k < noise.pairs.size(); ++k) {
    const Pair best = best_pair(e, tried, noise.pairs[k]);
    const auto alone = [&](std::size_t c) { return noise.alone(index(c), index(k)); };
    as_much += best.score > 0 && best.excess(e, alone(best.a), alone(best.b)) >= excess;
  }
  return (1.0 + static_cast<double>(as_much)) / (1.0 + static_cast<double>(noise.pairs.size()));
}

} // namespace

std::optional<HiddenPair> hidden_pair(const Evidence& e, double best_shape, double alpha) {
  const Tried tried = tried_in_pairs(e);
  if (tried.first == 0) return std::nullopt;
  const Pair best = best_pair(e, tried, e.pair_scores(tried.all, tried.first));
  if (best.score == 0) return std::nullopt;
  const auto [a, b, score] = best;
  if (!pair_found(score, {e.score(a), e.score(b)}, {e.limit(a), e.limit(b)}, best_shape)) return std::nullopt;
  const double p = chance_of_pair(e, tried, best.excess(e, e.score(a), e.score(b)));
  if (p > alpha) return std::nullopt;
  return HiddenPair{{a, b}, p};
}

} // namespace gumshoe::tracing
