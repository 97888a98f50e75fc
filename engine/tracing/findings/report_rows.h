#pragma once
/// Errors before and after: of the training readings, and of the final blocks, which are opened here once.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Fills rms and rows. The final blocks may veto: then true, and after is before.
bool compare(const Circumstances& circumstances, const Search& search, Trace& out);

} // namespace gumshoe::tracing
