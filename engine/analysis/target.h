#pragma once
/// The reverse question: which standard uncertainties would give a wanted expanded uncertainty?
#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// One for each of the scenario's targets and each output it names. Runs the model anew, with the same random
/// numbers for every trial of a standard uncertainty.
std::vector<TargetResult> target_uncertainties(const propagation::Experiment& experiment,
                                               const std::vector<Budget>& budgets, int threads);

} // namespace gumshoe::analysis
