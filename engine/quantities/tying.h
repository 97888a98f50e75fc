#pragma once
/// Correlations between the variates of a plan.
#include <span>

#include "quantities/sample_plan.h"

namespace gumshoe::quantities {

/// Adds to the plan the copula groups of one correlation, one for each cell its quantities share.
/// Throws InputError as make_plan() does.
void tie(std::span<const InputQuantity> quantities, const Correlation& correlation, SamplePlan& plan);

} // namespace gumshoe::quantities
