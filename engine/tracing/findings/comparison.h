#pragma once
/// Errors before and after, for the training readings and for the hold-out blocks, which are used here only.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Fills out.rms, out.rows and the outliers. Returns true if the hold-out blocks veto the findings; the
/// figures "after" then equal those "before".
bool compare(const TraceContext& context, const Search& search, Trace& out);

} // namespace gumshoe::tracing
