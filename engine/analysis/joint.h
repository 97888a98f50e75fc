#pragma once
/// Several measurands at once: JCGM 102 clause 7; and statistics of angles on the circle.
#include <functional>
#include <vector>

#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

using ValuesOf = std::function<std::vector<double>(std::size_t output)>;

/// Covariance and joint coverage regions of the scenario's groups (AnalysisOptions::joint), at each reading.
std::vector<JointRegion> joint_regions(const propagation::Experiment& experiment, const ValuesOf& values);

/// One for every output that is an angle.
std::vector<CircularSummary> circular_summaries(const propagation::Experiment& experiment, const ValuesOf& values);

} // namespace gumshoe::analysis
