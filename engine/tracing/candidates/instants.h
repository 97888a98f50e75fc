#pragma once
/// A step at an unknown instant: something gave way, was hit or was set to zero anew.
#include "tracing/candidates/gain.h"

namespace gumshoe::tracing {

/// For each indication and each course of the measurement (time, or the order): the step between two successive
/// readings that explains most. Its p-value counts as often as there are instants.
/// @param rows  of the readings that are fitted, in the order of measurement
std::vector<Candidate> steps_at_instants(const Observations& observations, const std::vector<Index>& rows,
                                         const Gain& gain);

} // namespace gumshoe::tracing
