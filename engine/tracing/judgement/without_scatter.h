#pragma once
/// The evidence of a round if the noise had no variance component.
#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// The same candidates with a noise that has no variance component.
class WithoutScatter {
public:
  WithoutScatter(const TraceContext& context, const Evidence& evidence);
  double score(std::size_t candidate) const; ///< as Evidence::score
  Fit fit(std::size_t candidate) const { return scan_.fit(candidate, evidence_.residuals()); }
  const CovarianceModel& model(const Fit& fit) const { return scan_.covariance_models()[fit.covariance_model]; }
  /// Probability that the best of some candidates would lead a variance component by so much if that were the cause; by
  /// simulation. 1 if another component fits better.
  double chance_of_lead(const std::vector<std::size_t>& of, std::size_t component, double lead) const;

private:
  const TraceContext& c_;
  const Evidence& evidence_;
  Design design_;
  Scan scan_;
  Statistics statistics_;
};

} // namespace gumshoe::tracing
