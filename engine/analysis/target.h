#pragma once
/// The reverse question: which standard uncertainties would give a wanted expanded uncertainty?
#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// One for each of the scenario's targets and each output it names. U is the one that the result states (certify()); of
/// trials it is that times the ratio of their half-widths about the mean, trial.h. Where the result states none, it is
/// the half-width itself.
///
/// A quantity's standard uncertainty is changed by scaling all deviations of its components about their means; its
/// distribution keeps its shape. `allowed` is found by running the model with the same random numbers for every trial
/// scale, to 0.1 % of the scale, up to 100 times the present uncertainty. `allowed_gum` solves the law of propagation.
///
/// With costs c_i of the present u_i0 (at u: c_i u_i0 / u), the cheapest combination under the linear law: minimise
/// sum c_i / s_i subject to sum q_i s_i^2 = const, s_i = u_i / u_i0, q_i the variance that the quantity contributes;
/// Lagrange: s_i ~ (c_i / q_i)^(1/3). A common factor, found by Monte Carlo, then makes U the target. Where the law
/// gives no q_i, the fall of U^2 without the quantity stands in. Quantities without a cost stay as they are.
///
/// Up to 100,000 points per model run, of the output's reading alone; the statement says how many runs were made.
std::vector<TargetResult> target_uncertainties(const propagation::Experiment& experiment,
                                               const std::vector<Summary>& summaries,
                                               const std::vector<Budget>& budgets, int threads);

} // namespace gumshoe::analysis
