#pragma once
/// The key `source` of a size in a traced scenario.
#include <string>

#include "tracing/candidates/candidates.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// Kind and p-value of a finding, and the 95 % interval of one of its sizes, in words.
/// @param scenario  the extended one, to whose quantities the amplitude belongs
std::string source_of(const Finding& finding, const Amplitude& amplitude, const scenario::Scenario& scenario);

} // namespace gumshoe::tracing
