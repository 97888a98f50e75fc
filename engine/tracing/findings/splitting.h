#pragma once
/// The measurement that would tell the members of a class apart.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// "measure at feed 8 mm/min too (all readings are at 4 mm/min)", found by trying measurements on the model: every
/// condition in turn at values that the data lack. Empty: none of those tried tells them apart.
std::string splitting_measurement(const TraceContext& context, const Search& search, const SearchFinding& finding);

} // namespace gumshoe::tracing
