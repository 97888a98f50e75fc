#pragma once
/// The outputs that a study of the scenario refers to.
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Indices of the outputs of a measurand at the readings with these labels, ascending; all readings if no label is given.
std::vector<std::size_t> outputs_named(const propagation::Experiment& experiment, const std::string& measurand,
                                       const quantities::Labels& labels);

} // namespace gumshoe::analysis
