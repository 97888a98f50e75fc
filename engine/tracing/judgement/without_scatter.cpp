#include "tracing/judgement/without_scatter.h"

#include <algorithm>

#include "tracing/criteria.h"

namespace gumshoe::tracing {

WithoutScatter::WithoutScatter(const TraceContext& c, const Evidence& e)
    : c_(c), evidence_(e), design_(without_components(e.fit().design)),
      scan_(design_, c.fitter.rows(), e.pointers(), c.threads), statistics_(scan_.run(e.residuals())) {}

double WithoutScatter::chance_of_lead(const std::vector<std::size_t>& of, std::size_t component, double lead) const {
  const Statistics& data = evidence_.assessment().data;
  if (evidence_.scan().covariance_models()[data.covariance_model[0]].scatter != static_cast<int>(component)) return 1;
  const Matrix drawn = evidence_.noise(criteria.rival_draws, c_.seed ^ 0x5ca7ull);
  std::vector<const Candidate*> candidates;
  for (const std::size_t a : of) candidates.push_back(&evidence_.candidates()[a]);
  const Matrix scatter = Scan(evidence_.fit().design, c_.fitter.rows(), {}, c_.threads).run(drawn).scatter,
               ratio = Scan(design_, c_.fitter.rows(), candidates, c_.threads).run(drawn).ratio;
  int as_much = 0;
  for (Index j = 0; j < drawn.cols(); ++j) {
    double best = 0;
    for (std::size_t a = 0; a < of.size(); ++a)
      best = std::max(best, ratio(index(a), j) - 2 * evidence_.assessment().null[of[a]].mean);
    as_much += best - scatter(index(component), j) >= lead;
  }
  return (1.0 + as_much) / (1.0 + static_cast<double>(criteria.rival_draws));
}

double WithoutScatter::score(std::size_t a) const { return statistics_.ratio(index(a), 0) - evidence_.chance(a); }

} // namespace gumshoe::tracing
