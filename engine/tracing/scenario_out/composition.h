#pragma once
/// Composition of the traced scenario.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Composes the traced scenario: unknowns and sizes with their joint covariance, the scenario in which they are
/// estimated quantities, and variance components. Empty if nothing was found.
void compose(const TraceContext& context, const Search& search, Trace& out);
/// Variance components of scatter and of unknown effects. `left` by term: the part that no free unknown absorbs, rows
/// in the order of measurement.
void add_components(const TraceContext& context, const Search& search, const std::vector<Vector>& left, Trace& out);

} // namespace gumshoe::tracing
