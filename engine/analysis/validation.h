#pragma once
/// The GUM framework against Monte Carlo: does it hold, and does it account for the variance of the samples?
#include "analysis/results.h"

namespace gumshoe::analysis {

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

} // namespace gumshoe::analysis
