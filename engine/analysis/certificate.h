#pragma once
/// The result as a certificate states it (GUM 7.2.3): Y = (y +- U), k and the coverage probability.
#include <string>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Fills in U, k, effective degrees of freedom and the certificate's line. They are the GUM framework's where Monte
/// Carlo validates it, else those of the samples. Without a standard uncertainty there is no such line.
void certify(Summary& summary, const Budget& budget, const Validation& validation, double coverage_probability);

/// "laser_z = (10.003387 +- 0.000099) mm, k = 1.96, 95 %" of a summary with U and k.
std::string certificate_line(const Summary& summary, double coverage_probability);

/// ", of u_c = 0.15 mm": the uncertainty that k of the framework multiplies, where it differs from u of the samples in
/// the digits shown. A t distribution with few degrees of freedom has its scale in u_c and its standard deviation in u.
/// Empty where both agree.
std::string uncertainty_of_factor(const Summary& summary, const Budget& budget);

} // namespace gumshoe::analysis
