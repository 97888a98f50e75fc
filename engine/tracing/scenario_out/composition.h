#pragma once
/// What goes into the traced scenario.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// What goes into the traced scenario: unknowns and sizes with their joint covariance, the scenario in which they are
/// estimated quantities, and variance components. Nothing if nothing was found.
void compose(const TraceContext& context, const Search& search, Trace& out);
/// Variance components: of scatter, and of what is not in the catalogue. `left` by term: what no free unknown absorbs
/// of it, rows in the order of measurement.
void add_components(const TraceContext& context, const Search& search, const std::vector<Vector>& left, Trace& out);

} // namespace gumshoe::tracing
