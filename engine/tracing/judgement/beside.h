#pragma once
/// Replaces a shape of many sizes by the two simpler causes that it contains.
#include <optional>

#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// The simpler shape to take instead of `shape`, if an effect (no declared value), or a shape of one size that depends
/// on something else that was recorded, counts in addition to it and the two are of equal merit with `shape` or better,
/// each size charged with what chance gives it. The other is then found in the next round, given the simpler shape: a
/// table by position and direction holds every reversal, whether there is one or not, and any curve in time or in one
/// temperature holds some of what two temperatures do. A surface over two conditions likewise gives way to a curve in
/// either, where they add up to it. An effect of the simpler shape's own conditions counts if no one
/// shape of as few sizes explains more. Shapes are simpler if they have fewer columns; at
/// most criteria.most_shapes are tried, the best ones.
std::optional<std::size_t> simpler_beside_another(const Evidence& evidence, const Observations& observations,
                                                  std::size_t shape);

} // namespace gumshoe::tracing
