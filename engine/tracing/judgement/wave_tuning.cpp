#include "tracing/judgement/wave_tuning.h"

#include <algorithm>
#include <cmath>

#include "tracing/candidates/waves.h"
#include "tracing/judgement/apart.h"

namespace gumshoe::tracing {
namespace {

constexpr double farthest = 0.25; ///< cycles of one step: a quarter of what the range resolves
constexpr double settled = 0.05;  ///< step in standard uncertainties below which a period stays
constexpr int most_steps = 8;

/// Change of the readings per cycle over the range.
Vector per_cycle(const Observations& o, const Term& wave) {
  constexpr double h = 1e-3;
  const double k = wave.candidate.cycles;
  return (at_cycles(o, wave.candidate, k + h).columns - at_cycles(o, wave.candidate, k - h).columns) * wave.size /
         (2 * h);
}

} // namespace

JointFit with_tuned_waves(const TraceContext& c, JointFit fit) {
  std::vector<std::size_t> waves;
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    if (fit.terms[t].candidate.cycles > 0 && fit.terms[t].size.size() == 2) waves.push_back(t);
  bool more = !waves.empty();
  for (int step = 0; more && step < most_steps; ++step) {
    Design design = fit.design;
    const Index first = design.fixed.cols(), n = index(waves.size());
    design.fixed.conservativeResize(Eigen::NoChange, first + n);
    for (Index w = 0; w < n; ++w) design.fixed.col(first + w) = per_cycle(c.observations, fit.terms[waves[index(w)]]);
    const auto use = independent(design, c.fitter.rows());
    const Whitened plain(design, c.fitter.rows(), use, {}), white(plain, fit.covariance_model);
    Matrix covariance;
    const Vector x = white.coefficients(plain.winsorised(plain.take(fit.residual)), &covariance);
    more = false;
    std::vector<Term> terms = fit.terms;
    for (Index w = 0; w < n; ++w) {
      const auto at = std::ranges::find(use, first + w);
      if (at == use.end()) continue;
      const Index j = at - use.begin();
      Term& wave = terms[waves[index(w)]];
      const double u = std::sqrt(covariance(j, j) * fit.variance), by = std::clamp(x[j], -farthest, farthest);
      fit.terms[waves[index(w)]].candidate.cycles_u = wave.candidate.cycles_u = u;
      if (std::fabs(by) <= settled * u) continue;
      more = true;
      Candidate tuned = at_cycles(c.observations, wave.candidate, wave.candidate.cycles + by);
      Candidate own = apart(tuned, fit, c.observations, c.fitter.rows());
      wave.candidate = own.columns.cols() == 2 ? std::move(own) : std::move(tuned);
    }
    if (!more) break;
    JointFit next = c.fitter.fit(terms, fit.noise, &fit);
    if (!next.valid || next.criterion > fit.criterion) break;
    fit = std::move(next);
  }
  return fit;
}

} // namespace gumshoe::tracing
