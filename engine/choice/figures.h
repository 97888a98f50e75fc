#pragma once
/// From the errors of a setting to its bias and expanded uncertainty.
#include <span>

#include "choice/results.h"

namespace gumshoe::choice {

/// Over all uncertain quantities. Corrected: U is the p-quantile of |e - mean|, so that +-U about the corrected result
/// covers the truth, enlarged by the standard error s / sqrt(n) of that correction (GUM F.2.4.5): sqrt(1 + 1/n).
/// Uncorrected: the p-quantile of |e|.
Figures average_figures(std::span<const double> errors, double p, scenario::Choose::Definition definition);

/// In a case, with the correction of the average, because nobody knows the case: U is the p-quantile of |e -
/// correction|, so that +-U about the corrected result still covers the truth. Uncorrected: `correction` 0.
Figures case_figures(std::span<const double> errors, double p, double correction);

/// Probability that a figure with this standard error truly lies below the limit; 0 or 1 without one.
double probability_below(double figure, double standard_error, double limit);

} // namespace gumshoe::choice
