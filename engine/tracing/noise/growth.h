#pragma once
/// Noise that grows with the size of a condition, as a relative uncertainty makes it: u^2 = a^2 + (b x)^2.
#include <optional>
#include <vector>

#include "tracing/noise/replicates.h"

namespace gumshoe::tracing {

struct NoiseGrowth {
  std::size_t covariate = 0; ///< index into Observations::covariates
  double ratio = 0;          ///< b x / a at the largest x
  double largest = 0;        ///< largest |x| met, SI
  Vector variance;           ///< by reading of the scenario: u^2 / a^2
};

/// The condition with which the noise grows most plainly; none unless the likelihood says so by criteria.noise_grows.
/// Judged by what is left about the model, the means of equal conditions and, in every pass, a constant, a straight
/// line in time and the same in proportion to x; so neither what repeats nor a gain that differs or drifts from pass to
/// pass looks like noise. The likelihood is that of Student's t with five degrees of freedom: a bad reading at large x
/// does not decide.
/// @param rows   chosen rows
/// @param about  their residuals about the model and the means of equal conditions, in units of the noise so far
std::optional<NoiseGrowth> noise_growth(const Observations& observations, const Replicates& replicates,
                                        const std::vector<Index>& rows, const Vector& about);

} // namespace gumshoe::tracing
