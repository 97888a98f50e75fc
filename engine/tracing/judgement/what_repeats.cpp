#include "tracing/judgement/what_repeats.h"

#include <cmath>
#include <utility>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

double measured(const TraceContext& c, const Design& d, Index row) {
  return c.observations.measured[d.reading[index(row)] * d.indications + index(row) % d.indications];
}

} // namespace

Repeats repeats_of(const TraceContext& c, const JointFit& fit) {
  Repeats out{PureError(fit.design, c.fitter.rows(), c.fitter.replicates(), c.threads),
              {},
              c.observations.blocks.groups.size(),
              std::sqrt(12.0) * least_scale(fit.design, c.fitter.rows())};
  if (out.blocks < criteria.blocks_for_folds) out.blocks = 0;
  for (const Index row : c.fitter.rows())
    if (out.blocks > 0) out.block.push_back(c.observations.blocks.group[fit.design.reading[index(row)]]);
  if (!out.pure.known()) return out;
  const Vector residual = fit.residual(c.fitter.rows());
  Vector predicted = -residual;
  for (Index i = 0; i < predicted.size(); ++i) predicted[i] += measured(c, fit.design, c.fitter.rows()[index(i)]);
  out.steps = CoarseSteps(fit.design, c.fitter.rows(), std::move(predicted), out.pure.scale_by_indication(residual),
                          out.pure.freedom() / static_cast<double>(fit.design.indications), c.observations.of_readouts);
  return out;
}

} // namespace gumshoe::tracing
