#pragma once
/// Sensitivity from samples that exist: no new model runs.
#include "analysis/joint.h"

namespace gumshoe::analysis {

/// From the first `samples` of the run, whose inputs are drawn again.
std::vector<GivenData> given_data_indices(const propagation::Experiment& experiment, const ValuesOf& values,
                                          std::uint64_t samples, int threads);

} // namespace gumshoe::analysis
