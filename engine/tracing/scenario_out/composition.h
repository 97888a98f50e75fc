#pragma once
/// Composition of the traced scenario.
#include "tracing/judgement/search.h"

namespace gumshoe::tracing {

/// Composes the traced scenario: unknowns and sizes with their joint covariance, the scenario in which they are
/// estimated quantities, and variance components. Empty if nothing was found in a scenario that leaves nothing free.
void compose(const TraceContext& context, const Search& search, Trace& out);
/// Variance components of scatter and of unknown effects. `left` by term: the part that no free unknown absorbs, rows
/// in the order of measurement.
void add_components(const TraceContext& context, const Search& search, const std::vector<Vector>& left, Trace& out);

/// The noise as fitted, where the scenario declares none: in the traced one it weighs the readings as it did here.
void add_estimated_noise(const TraceContext& context, const Search& search, Trace& out);

} // namespace gumshoe::tracing
