#include "tracing/judgement/beside.h"

#include "tracing/criteria.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

std::optional<std::size_t> simpler_beside_effect(const Evidence& e, std::size_t shape) {
  std::vector<Scored> simpler;
  for (std::size_t a = 0; a < e.candidates().size(); ++a) {
    const Candidate& c = e.candidates()[a];
    simpler.push_back({c.name, e.score(a),
                       !c.physical() && c.columns.cols() < e.candidates()[shape].columns.cols() &&
                           e.assessment().p[a] <= e.assessment().threshold});
  }
  double best = 0;
  std::optional<std::size_t> out;
  for (const std::size_t s : best_of(simpler, criteria.most_shapes)) {
    // The noise as it is with the simpler shape: without any, a large one passes for correlation.
    const std::size_t model = e.scan().fit(s, e.residuals()).covariance_model;
    const double alone = e.scan().pair_ratio(s, s, e.residuals(), model);
    for (std::size_t a = 0; a < e.candidates().size(); ++a) {
      // One of the declared values would take the bend of any table.
      if (!e.testable(a) || e.candidates()[a].family == Family::declared || e.candidates()[a].in_part()) continue;
      const double added = e.scan().pair_ratio(s, a, e.residuals(), model) - alone;
      const double both = simpler[s].score + added - 2 * e.assessment().null[a].mean;
      if (counts_beside(both, {e.score(a), simpler[s].score}, added, {e.limit(a), e.limit(s)}, e.score(shape)) &&
          both > best) {
        best = both;
        out = s;
      }
    }
  }
  return out;
}

} // namespace gumshoe::tracing
