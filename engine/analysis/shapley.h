#pragma once
/// Shapley effects: shares of the variance for dependent inputs.
#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

std::vector<Shapley> shapley_effects(const propagation::Experiment& experiment, std::uint64_t rows, int threads);

} // namespace gumshoe::analysis
