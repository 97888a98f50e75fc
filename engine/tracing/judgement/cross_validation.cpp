#include "tracing/judgement/cross_validation.h"

#include <algorithm>

#include "tracing/judgement/holdout.h"

namespace gumshoe::tracing {

double cross_validated(const Observations& o, const std::vector<Index>& rows, const JointFit& fit,
                       const Structure& structure) {
  double squares = 0;
  const Whitened plain(fit.design, rows, independent(fit.design, rows), {});
  Matrix clean = fit.residual;
  const Vector chosen = plain.winsorised(plain.take(fit.residual));
  for (std::size_t i = 0; i < rows.size(); ++i) clean(rows[i], 0) = chosen[static_cast<Index>(i)];
  for (const auto& fold : folds(o, rows)) {
    std::vector<Index> train;
    std::set_difference(rows.begin(), rows.end(), fold.begin(), fold.end(), std::back_inserter(train));
    // Sizes of terms are found anew without the fold: they are fixed columns of the design.
    const HeldOut held = hold_out(fit.design, clean, Matrix(clean.rows(), 0), train, fold, structure);
    if (held.count > 0) squares += held.whitened[0];
  }
  return squares;
}

} // namespace gumshoe::tracing
