#pragma once
/// Findings that others found since make superfluous.
#include <set>
#include <string>

#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// The fit with the terms of another, its noise found anew.
JointFit fitted_anew(const TraceContext& context, const JointFit& fit);
/// Fits what a search with another fitter found. @param base  without the terms
void fit_all_anew(const TraceContext& context, const JointFit& base, Search& search);

/// Drops findings that no longer count given all that was found, one after the other, and settles classes.
/// @param dropped  names of candidates that are not tried again; those dropped are added
void prune(const TraceContext& context, Search& search, std::set<std::string>& dropped);

} // namespace gumshoe::tracing
