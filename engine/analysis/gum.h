#pragma once
/// The GUM uncertainty framework: JCGM 100 clause 5 and Annex G, with exact derivatives.
#include "analysis/results.h"
#include "propagation/experiment.h"
#include "propagation/work.h"

namespace gumshoe::analysis {

/// The budget of one output by the law of propagation of uncertainty. It has one row per variate that reaches the
/// output (analysis/reach.h, in order). c_i comes from dual numbers through the solver, or from differences near a
/// kink. The second-order terms of the note to 5.1.2 use differences of exact first derivatives as third derivatives.
/// Where the model has no derivative at the estimate, the row says so and the framework does not apply. A virtual
/// experiment has no measurement model of its inputs; its budget is "not applicable".
Budget budget(const propagation::Experiment& experiment, std::size_t output, double coverage_probability);
/// The budgets of all measurands of one reading, whose derivatives are found together.
/// @param first  the first of its outputs: a multiple of the number of measurands
std::vector<Budget> budgets(const propagation::Experiment& experiment, std::size_t first, double coverage_probability,
                            const propagation::Workers& workers = 1);
/// Whether terms of second order are found for quantities with these standard uncertainties: for at most 100 of them.
bool has_second_order(const std::vector<double>& standard_uncertainties);

/// Whether the contributions of correlated inputs cancel: the correlations take off more than the variance that is left.
/// Contributions are then no shares of it.
bool contributions_cancel(const Budget& budget);
/// Standard uncertainty that the contributions would combine to without correlations.
double uncorrelated_uncertainty(const Budget& budget);

/// Whether any input has a standard uncertainty, whatever its sensitivity coefficient.
bool any_uncertain(const Budget& budget);

/// Distance from a number of double precision to the next.
double spacing_of_doubles(double at);
/// Whether samples about the estimate show a standard uncertainty: it is many such distances.
bool resolved(const Summary& summary, double standard_uncertainty);

/// "per setup", "per rod, setup", "" for a draw that all readings share.
std::string scope_text(const quantities::Component& component);

} // namespace gumshoe::analysis
