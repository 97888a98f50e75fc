#pragma once
/// Cheap studies of many inputs: Morris' elementary effects, derivative-based measures, one at a time.
#include "analysis/results.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// Elementary effects (Morris 1991) of every variate on every output it reaches, in a radial design (Campolongo,
/// Saltelli, Cariboni 2011): from each of `trajectories` random base points every variate in turn is moved by half of
/// its distribution, from its quantile at q to the one at q + 1/2 (modulo 1); trajectories (d + 1) model runs.
/// Scaling: an effect is the change of the output, over the step in standard uncertainties of the variate (t with two
/// degrees of freedom or fewer: half the length of its central 68.27 % interval). So effects have the output's unit,
/// and of a linear model each is c_i u_i, as in a budget, and their standard deviation is zero.
/// A base point at which any run failed is dropped whole and counted. NaN where a variate never moves.
/// Throws InputError for correlated inputs: one cannot be moved alone.
std::vector<Morris> morris_screening(const propagation::Experiment& experiment, std::uint64_t trajectories,
                                     const propagation::Workers& workers);
/// Its model runs; a unit is eight base points.
propagation::Work morris_work(const propagation::Experiment& experiment, std::uint64_t trajectories);

/// nu_i = E[(df/dx_i)^2] at `points` independent draws of all inputs, by exact derivatives where the model has them; a
/// model without any, or a virtual experiment as a whole, by central differences over a thousandth of a standard
/// uncertainty. Bound on the total index: T_i <= C_i nu_i / V (Sobol' and Kucherenko 2009; Lamboni et al. 2013), C_i
/// of poincare_constant(), V the variance of the run's summary; NaN for correlated inputs, where it does not hold.
/// Intervals: 95 %, from the standard errors of nu and V. A point without value or derivative is dropped and counted.
std::vector<Dgsm> derivative_measures(const propagation::Experiment& experiment, std::uint64_t points,
                                      const std::vector<Summary>& summaries, const propagation::Workers& workers);
/// Its model runs; a unit is eight points.
propagation::Work dgsm_work(const propagation::Experiment& experiment, std::uint64_t points);

/// The scenario's tables: changes of all outputs when one quantity moves up or down by its step, at every reading at
/// once, the others at their estimates. In a virtual experiment the true value moves, not what the evaluation
/// believes: changes of the error.
std::vector<OneAtATimeTable> one_at_a_time(const propagation::Experiment& experiment,
                                           const propagation::Workers& workers = 1);
/// Their model runs, a work for each table; a unit is one point.
std::vector<propagation::Work> one_at_a_time_work(const propagation::Experiment& experiment);

} // namespace gumshoe::analysis
