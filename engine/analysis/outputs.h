#pragma once
/// Which outputs a study means.
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Outputs of that measurand at readings with those labels (all readings if there are none), in order.
std::vector<std::size_t> outputs_named(const propagation::Experiment& experiment, const std::string& measurand,
                                       const quantities::Labels& labels);

} // namespace gumshoe::analysis
