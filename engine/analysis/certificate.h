#pragma once
/// The result as a certificate states it (GUM 7.2.3): Y = (y +- U), k and the coverage probability.
#include "analysis/results.h"

namespace gumshoe::analysis {

/// Fills in U, k, effective degrees of freedom and the certificate's line. They are the GUM framework's where Monte
/// Carlo validates it, else those of the samples. Without a standard uncertainty there is no such line.
/// `error`: the output is an error, a difference of two values, and converts by scale.
void certify(Summary& summary, const Budget& budget, const Validation& validation, double coverage_probability,
             bool error);

} // namespace gumshoe::analysis
