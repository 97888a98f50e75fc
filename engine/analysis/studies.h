#pragma once
/// The model runs of all studies of a scenario, for processes that share them.
#include <vector>

#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Everything that analyse() asks its workers for. Target uncertainties are missing: each of their runs follows from
/// the one before. The experiment must outlive it.
std::vector<propagation::Work> studies_of(const propagation::Experiment& experiment);

} // namespace gumshoe::analysis
