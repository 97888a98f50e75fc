#pragma once
/// Composition of the traced scenario.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Composes the traced scenario: unknowns and sizes with their joint covariance, the scenario in which they are
/// estimated quantities, and variance components. Empty if nothing was found in a scenario that leaves nothing free.
void compose(const TraceContext& context, const Search& search, Trace& out);
/// Variance components: scatter, found or not, unknown effects, and the noise of a reading where none was declared,
/// which in the traced scenario weighs the readings as it did here. `left` by term: the part that no free unknown
/// absorbs, rows in the order of measurement.
void add_components(const TraceContext& context, const Search& search, const std::vector<Vector>& left, Trace& out);

} // namespace gumshoe::tracing
