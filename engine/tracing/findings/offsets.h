#pragma once
/// Quantities that are fitted for each value of a label: what differs between these values is absorbed, not judged.
#include <string>
#include <vector>

#include "tracing/trace.h"

namespace gumshoe::tracing {

/// A sentence for each free quantity with several fitted values: the label, and how far the values differ.
std::vector<std::string> fitted_by_label(const Trace& trace);

} // namespace gumshoe::tracing
