#pragma once
/// Scatter of readings as a fit knows it, and as new readings will show it: by group, nested or not, and of each one.
#include <vector>

#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// A variance component given the others.
struct Component {
  const Grouping* group = nullptr;
  int index = -1;      ///< into Design::scatter; -1: of too few groups to be searched
  bool found = false;  ///< it is a finding of its own
  int indication = -1; ///< the only one that it moves; -1: each by itself
  double u = 0;        ///< standard deviation, in units of Design::reference
  double freedom = 0;  ///< its degrees of freedom
};

struct FittedScatter {
  std::vector<Component> components; ///< of few groups before those of many
  double variance = 1;               ///< of a reading about them, in units of the design's noise
  double freedom = 0;                ///< degrees of freedom of that
};

/// Components that were found, and those on which the likelihood insists given these (criteria.decisive), with the
/// sizes that are most likely together. A component that the fit uses without insisting on it counts as noise of each
/// reading.
FittedScatter fitted_scatter(const TraceContext& context, const JointFit& fit,
                             const std::vector<SearchFinding>& findings);

/// The fit with all of these components but one as declared draws.
JointFit given_others(JointFit fit, const FittedScatter& scatter, int component);

} // namespace gumshoe::tracing
