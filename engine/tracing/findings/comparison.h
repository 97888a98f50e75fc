#pragma once
/// Errors before and after: of the training readings, and of the hold-out blocks, which are opened here once.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Fills out.rms, out.rows and the number of outliers. True if the hold-out blocks veto what was found: then the
/// figures after are those before.
bool compare(const TraceContext& context, const Search& search, Trace& out);

} // namespace gumshoe::tracing
