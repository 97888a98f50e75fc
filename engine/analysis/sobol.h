#pragma once
/// Sobol' indices by pick-freeze: first-order, total, second-order.
#include <vector>

#include "analysis/results.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Indices of every output by every factor (pick_freeze.h) that reaches it, from n rows (rounded up to a multiple of
/// 64) of the design of pick_freeze.h; n (d + 2) model runs, or n (2 d + 2) with `second_order`. V is the variance of
/// y.
///   total:        Jansen 1999, mean (y_A - y_AB_i)^2 / 2 V.
///   first order:  correlation of y_B and y_AB_i, which share only x_i (Martinez 2011; Janon 2014), with
///                 (1 - total) corr(y_A, y_B), which is zero in the mean, subtracted as a control variate.
///   second order: mean (y_AB_i - y_A) (y_BA_j - y_B) / V. Of the four products' means, y_AB_i y_BA_j share x_i and
///                 x_j, y_AB_i y_B share x_i, y_A y_BA_j share x_j and y_A y_B nothing, so V_ij + V_i + V_j, V_i and
///                 V_j cancel to V_ij; the mean over (i, j) and (j, i) is taken.
/// With `second_order` the rows BA_i serve the first and total indices too, as mirror images of AB_i.
///
/// Intervals: confidence 95 %, estimate +- t SE, not cut at 0 or 1. SE by the delta method: the estimator's influence
/// values summed over groups of rows, whose spread needs no model of the output's distribution and no resampling.
/// Verdicts: index_verdict.h. An output that does not vary has no indices: NaN, "not converged".
/// A row in which any run failed is dropped whole and counted.
/// Throws InputError for correlated inputs: the indices are defined for independent ones.
std::vector<Sensitivity> sobol_indices(const propagation::Experiment& experiment, std::uint64_t n,
                                       const propagation::Workers& workers);

} // namespace gumshoe::analysis
