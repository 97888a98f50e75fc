#pragma once
/// First-order and total Sobol' indices by pick-freeze.
#include <vector>

#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Indices of every output by every variate that reaches it. Base size n: rows A and B of independent
/// draws, and for each variate i the row AB_i: A with i taken from B; n (d + 2) model runs.
///   total:       Jansen 1999, mean (y_A - y_AB_i)^2 / 2 V;
///   first order: correlation of y_B and y_AB_i, which share only x_i (Martinez 2011; Janon 2014), with
///                (1 - total) corr(y_B, y_A), which is zero in the mean, taken off as a control variate.
/// Intervals: 95 %, bootstrap over groups of 64 rows, 400 resamples. A row in which any run failed is dropped
/// whole and counted. Throws InputError for correlated inputs: the indices are defined for independent ones.
std::vector<Sensitivity> sobol_indices(const propagation::Experiment& experiment, std::uint64_t n, int threads);

} // namespace gumshoe::analysis
