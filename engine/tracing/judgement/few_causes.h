#pragma once
/// A few causes in place of scatter from group to group.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Whether a search found scatter of groups.
bool groups_scatter(const Search& search);

/// Two tools that were hit, one after the other, look like scatter from one day and tool to the next: with either alone
/// much of it is left. The search is done anew as if no groups could scatter. What it finds is there in place of the
/// scatter where nothing is left after it, no group scatters, and its likelihood leads by more than all that
/// its findings had to exceed: scatter of many groups needs many causes.
/// @param all  a search; none is returned if it found no scatter of groups, and its noise holds none
std::optional<Search> few_causes(const TraceContext& context, const Search& all);

} // namespace gumshoe::tracing
