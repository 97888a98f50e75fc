#pragma once
/// The candidates that a round fits with the whole model, best first.
#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// Effects and declared quantities that could win. The first passes by itself; the others may be members of its class.
/// Empty: none passes.
std::vector<Trial> physical_trials(const Evidence& evidence);

/// Shapes that pass by themselves, in the order in which they are there (shape_order.h), a simpler one of the same with
/// another finding before them.
std::vector<Trial> shape_trials(const TraceContext& context, const Evidence& evidence);

} // namespace gumshoe::tracing
