#pragma once
/// Cheap studies of many inputs: Morris' elementary effects, derivative-based measures, one at a time.
#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

std::vector<Morris> morris_screening(const propagation::Experiment& experiment, std::uint64_t trajectories,
                                     int threads);
std::vector<Dgsm> derivative_measures(const propagation::Experiment& experiment, std::uint64_t points,
                                      const std::vector<Summary>& summaries, int threads);
std::vector<OneAtATimeTable> one_at_a_time(const propagation::Experiment& experiment);

} // namespace gumshoe::analysis
