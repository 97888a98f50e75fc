#pragma once
/// Sensitivity from samples that exist: no new model runs.
#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Indices of every output with respect to every variate that reaches it, from the first `samples` of the run: inputs
/// are drawn again from the run's design and seed, outputs are `values`. Failed samples are dropped and counted.
/// Dependent inputs are allowed: an index then includes what the input tells about those correlated with it, and the
/// sum of the first-order indices may exceed 1.
///   first: var E[Y|X] / V by ranks: 1 - sum (y_(i+1) - y_(i))^2 / (2 n V), y in the order of x, ties of x in random
///          order (Chatterjee 2021; Gamboa, Gremaud, Klein, Lagnoux 2022, in differences). Interval: its terms are
///          1-dependent given x, so with g_k the autocovariances of their influences in the order of x the variance is
///          (g_0 + 2 (g_1 - g_2)) / n. NaN where an input has no variance.
///   delta: half the expected L1 distance of the densities of Y and of Y given X (Borgonovo 2007), from tables of
///          classes of equal probability in x and in y (Plischke, Borgonovo, Smith 2013), 8 to 64 of each, the finest
///          that pays; each cell's |difference| less its bias by chance, see README. A third of what the last
///          refinement brought is added for what finer classes would bring, and widens the interval.
/// Intervals: 95 %, for independent samples; no theory is known here for Sobol' points, for a Latin hypercube they are
/// rather too wide. Cost: one sort per variate, shared by all outputs.
std::vector<GivenData> given_data_indices(const propagation::Experiment& experiment, const ValuesOf& values,
                                          std::uint64_t samples, int threads);

/// Both indices of y by x (equal lengths, no NaN). `key`: of the random order of ties.
struct GivenDataPair {
  Index first, delta;
};
GivenDataPair given_data_pair(const std::vector<double>& x, const std::vector<double>& y, std::uint64_t key);

} // namespace gumshoe::analysis
