#pragma once
/// One finding in words for a machinist.
#include <string>

#include "tracing/trace.h"

namespace gumshoe::tracing {

/// The indication that a shape moves, where there are several; empty: all, or the only one.
std::string indication_of(const Trace& trace, const Finding& finding);

/// A sentence. @param of  indication_of
std::string what_was_found(const Finding& finding, const std::string& of);
/// "axis_drift (amplitude 1.5 um)", "an unknown effect of position"
std::string briefly(const Finding& finding);

} // namespace gumshoe::tracing
