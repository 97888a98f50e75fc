#pragma once
/// A weighted mean of results as a scenario: `gumshoe run` then gives its result file, budget and report.
#include <string>
#include <vector>

#include "analysis/weighted_mean.h"

namespace gumshoe::calibration {

/// Text of a scenario whose one measurand is the mean. It has a quantity for every result, with what is its own, and
/// one for every shared component, in the unit of the measurand: normal, or t with the degrees of freedom.
std::string combined_scenario(const analysis::WeightedMean& mean, const std::vector<analysis::NamedResult>& results);

} // namespace gumshoe::calibration
