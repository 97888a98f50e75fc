#pragma once
/// The measurement that would distinguish the members of a class.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// The cheapest plan of the readings that [plan] allows, if the scenario has one that distinguishes them. Else
/// "also measure at feed 8 mm/min (all readings are at 4 mm/min)", found by trying measurements on the model: every
/// condition in turn at values that the data lack. Empty: none of those tried distinguishes them.
std::string splitting_measurement(const TraceContext& context, const Search& search, const SearchFinding& finding);

} // namespace gumshoe::tracing
