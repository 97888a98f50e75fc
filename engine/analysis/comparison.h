#pragma once
/// Differences between readings from joint samples, and printed values beside ours.
#include <vector>

#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Every pair of readings that differ in `between` and agree in `within`. `values[output]` are the samples;
/// empty vectors for outputs that no comparison needs.
std::vector<ComparisonResult> compare(const propagation::Experiment& experiment,
                                      const std::vector<std::vector<double>>& values,
                                      const std::vector<Summary>& summaries);

std::vector<PrintedResult> beside_printed(const propagation::Experiment& experiment,
                                          const std::vector<Summary>& summaries);

} // namespace gumshoe::analysis
