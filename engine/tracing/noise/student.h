#pragma once
/// The scale of residuals with a few bad ones among them.
#include <vector>

namespace gumshoe::tracing {

/// Residuals of one kind. A residual counts by the share of its variance that what was fitted leaves.
struct Residuals {
  std::vector<double> share, square; ///< square: of the residual, over its share
};

struct ScaleFound {
  double variance = 0;   ///< 0: nothing is left
  double likelihood = 0; ///< 2 ln L but for a constant
};

/// Scale and likelihood of Student's t with five degrees of freedom.
ScaleFound scale_of(const Residuals& residuals);

} // namespace gumshoe::tracing
