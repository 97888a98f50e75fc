#pragma once
/// The result as a certificate states it (GUM 7.2.3): Y = (y +- U), k and the coverage probability.
#include <string>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Fills in U, k, effective degrees of freedom and the certificate's line. They are the GUM framework's where Monte
/// Carlo validates it, else those of the samples. Without a standard uncertainty there is no such line.
/// `error`: the output is an error, a difference of two values, and converts by scale.
void certify(Summary& summary, const Budget& budget, const Validation& validation, double coverage_probability,
             bool error);

/// "laser_z = (10.003387 +- 0.000099) mm, k = 1.96, 95 %" of a summary with U and k.
std::string certificate_line(const Summary& summary, double coverage_probability, bool error = false);

/// ", of u_c = 0.15 mm", that U of the framework is k times, where Monte Carlo has another u in the digits shown: of t
/// distributions with few degrees of freedom u_c has the scale, u the standard deviation. Else empty.
std::string uncertainty_of_factor(const Summary& summary, const Budget& budget);

} // namespace gumshoe::analysis
