#pragma once
/// Shapley effects: shares of the variance for dependent inputs.
#include "analysis/results.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Up to so many variates all subsets are run, beyond it random orders.
inline constexpr std::size_t most_for_all_subsets = 8;

/// Effects on every output of the variates that reach it, from n rows (rounded up to a multiple of 64). The effect of
/// x_i is what it adds to Var(E[y | x_J]), J being those before it in an order, averaged over all orders (Owen 2014;
/// Song, Nelson, Staum 2016), divided by Var(y): the effects add up to 1. For independent inputs it lies between the
/// first-order and the total index.
///
/// A row draws y and, for a set J, y^J with x_J kept and the others drawn afresh given x_J (conditional_draws.h).
/// E (y - y^J)^2 / 2 = E Var(y | x_J) = Var(y) - Var(E[y | x_J]), so differences of w_J = (y - y^J)^2 / 2 along an
/// order estimate the effects, and in each row they add up to w of the empty set, whose mean is Var(y).
/// Up to 8 variates: all 2^d sets, weighted as in the mean over all orders; n 2^d model runs. Beyond: for every 8
/// rows one random order, taken forwards and backwards; 2 n d model runs. Outputs that the same variates reach share
/// their runs.
/// Intervals (95 %) and verdicts as for Sobol' indices. A row in which any run failed is dropped whole and counted.
std::vector<Shapley> shapley_effects(const propagation::Experiment& experiment, std::uint64_t rows,
                                     const propagation::Workers& workers);
/// Its model runs: one work for each set of outputs that the same variates reach. A unit is one group of rows.
std::vector<propagation::Work> shapley_work(const propagation::Experiment& experiment, std::uint64_t rows);

} // namespace gumshoe::analysis
