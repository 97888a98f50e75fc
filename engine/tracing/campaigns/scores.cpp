#include "tracing/campaigns/scores.h"

#include <map>

#include "tracing/criteria.h"

namespace gumshoe::tracing {

Campaign scores_of(const TraceContext& c, const JointFit& fit) {
  const auto& rows = c.fitter.rows();
  const auto use = independent(fit.design, rows);
  const Whitened plain(fit.design, rows, use, {}), w(fit.design, rows, use, fit.covariance_model);
  const Matrix left = w.reduce(plain.winsorised(plain.take(fit.residual)));
  Campaign out;
  out.title = c.experiment.scenario().title;
  out.readings = static_cast<int>(rows.size() / fit.design.indications);
  out.squares = left.squaredNorm();
  out.freedom = static_cast<double>(w.degrees_of_freedom());
  const auto all =
      physical_candidates(c.experiment, c.simulator, fit.at, c.observations, 0, [](const auto&) { return false; });
  std::map<std::string, int> variants;
  for (const Candidate& a : all) {
    if (a.finite != 0) continue;
    const int variant = variants[a.name]++;
    const Matrix columns = w.take(a.columns), g = w.reduce(columns), information = g.transpose() * g;
    if ((information.diagonal().array() <=
         criteria.absorbed_share * w.whiten(columns).colwise().squaredNorm().transpose().array())
            .any())
      continue;
    Score one{a.name, variant, {}, g.transpose() * left.col(0), (information + information.transpose()) / 2};
    for (const Amplitude& amplitude : a.amplitudes)
      one.sizes.push_back({amplitude.scenario_name, amplitude.unit, amplitude.si_unit});
    out.scores.push_back(std::move(one));
  }
  return out;
}

} // namespace gumshoe::tracing
