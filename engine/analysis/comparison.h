#pragma once
/// Differences between readings, from joint samples, and published values compared with the computed ones.
#include <vector>

#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Compares every pair of readings whose labels differ in `between` and agree in `within` ([analysis] comparisons of
/// the scenario): difference, its standard uncertainty from the joint samples, E_n. Where the difference has no mean
/// or no variance (withhold()), it is that of the medians, or has no uncertainty and no E_n.
///
/// @param budgets  by output, as the summaries
/// @param threads 0: all processors
/// Source of E_n: ISO 13528, 9.7.
std::vector<ComparisonResult> compare(const propagation::Experiment& experiment, const ValuesOf& values,
                                      const std::vector<Summary>& summaries, const std::vector<Budget>& budgets,
                                      int threads);

/// Each reading that was taken, next to its prediction, SI. Empty unless the method is prediction.
std::vector<PredictedReading> predicted_readings(const propagation::Experiment& experiment,
                                                 const std::vector<Summary>& summaries);

/// The published values that the scenario lists under `printed`, each with our estimate of the same measurand.
std::vector<PrintedResult> beside_printed(const propagation::Experiment& experiment,
                                          const std::vector<Summary>& summaries);

} // namespace gumshoe::analysis
