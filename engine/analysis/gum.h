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

/// JCGM 101 clause 8: compares d_low and d_high with the numerical tolerance delta of u at `digits`. The Monte Carlo
/// tolerance is two standard errors of an end. The result is undecided below 100 / (1 - p) trials, if that tolerance
/// exceeds delta / 5 (unless an end differs by more than delta and four standard errors), or if an end differs by more
/// than delta alone. No verdict unless the framework's U is finite.
Validation validate(const Budget& budget, const Summary& summary, double coverage_probability, int digits);

/// Variance of a component's samples over the square of the u that the law of propagation takes: nu / (nu - 2) of a t
/// with nu degrees of freedom, 1 of all others; 1 also where that variance does not exist.
double variance_over_scale(const Contribution& contribution);

/// Whether the law of propagation accounts for the variance by Monte Carlo: both differ by no more than 5 % and twice
/// the Monte Carlo standard error, where a t distribution contributes its variance and not the square of its scale.
/// Where that standard error does not exist (a t of four degrees of freedom or fewer), the coverage intervals are
/// compared: half their lengths differ by no more than 10 %, to which effective degrees of freedom hold.
/// Otherwise the shares of the law are not those of the variance.
bool accounts_for_variance(const Budget& budget, const Summary& summary);

/// The summary with u, U and k of the budget, where its samples have no variance (a t with two degrees of freedom or
/// fewer) and the framework applies; else as it is. @param budget  may be null
Summary with_stated_uncertainty(Summary summary, const Budget* budget);

/// "per setup", "per rod, setup", "" for a draw that all readings share.
std::string scope_text(const quantities::Component& component);

} // namespace gumshoe::analysis
