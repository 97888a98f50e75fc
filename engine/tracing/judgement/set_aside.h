#pragma once
/// Readings that are off, in place of noise that is larger in all of them.
#include <optional>

#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Rows of the readings to set aside before noise is called larger: those that are winsorised, and those that are once
/// these are left out. Empty if there are none, or more than a few (criteria.h): then all readings scatter.
std::vector<Index> outlying_rows(const TraceContext& context, const JointFit& fit);

/// A search without these rows, as one of all readings: its terms are fitted to all of them again, in which the
/// outlying ones count as winsorised.
Search with_all_readings(const TraceContext& context, const Search& all, Search without, std::size_t set_aside);

} // namespace gumshoe::tracing
