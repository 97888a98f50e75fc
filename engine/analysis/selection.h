#pragma once
/// A part of the results: what is printed and reported of a run with many outputs.
#include <functional>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Drops what is about other outputs. Of joint regions those remain of which every output is wanted; comparisons,
/// conformity tests, targets and published figures are asked for by name and remain.
void keep_outputs(Results& results, const std::function<bool(const propagation::Output&)>& wanted);

/// The measurands that the scenario selects; an empty list selects all.
void keep_measurands(Results& results, const std::vector<std::string>& measurands);

} // namespace gumshoe::analysis
