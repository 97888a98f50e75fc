#pragma once
/// The two passes of moments(), which show their leaves to a sieve by the way.
#include "analysis/sieve.h"
#include "analysis/summary.h"

namespace gumshoe::analysis {

/// The mean and the number of values. `also`: null, or a sieve that takes all values.
Moments first_moments(const Column& values, int threads, Sieve* also);

/// The others, after these.
void add_central_moments(Moments& moments, const Column& values, int threads, Sieve* also);

} // namespace gumshoe::analysis
