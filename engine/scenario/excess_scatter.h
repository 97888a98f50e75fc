#pragma once
/// Repeats that scatter by more than is declared of one indication.
#include <string>
#include <vector>

#include "base/card.h"
#include "scenario/repeatability.h"

namespace gumshoe::scenario {

/// What is declared of one indication, SI; 0: nothing.
struct DeclaredNoise {
  double u = 0; ///< standard uncertainty
  Scatter repeatability;
  double step = 0; ///< of the display
};

/// One sentence if the repeats scatter by more than u and the repeatability explain at a significance of 0.001, with
/// both figures; empty if they do not, or if neither is declared. A chi-squared test of the scatter pooled over all
/// readings; an F test where the repeatability has degrees of freedom. Rounding to steps adds at most half a step to
/// the scatter.
std::string excess_scatter(const std::vector<Readouts>& readings, const DeclaredNoise& declared,
                           const VariableCard& card);

} // namespace gumshoe::scenario
