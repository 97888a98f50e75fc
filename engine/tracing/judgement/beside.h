#pragma once
/// A shape of many sizes that holds a known effect and a simpler shape.
#include <optional>

#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// The simpler shape to take instead of `shape`, if an effect (no declared value) counts in addition to it and the two
/// are of equal merit with `shape` or better, each size charged with what chance gives it. The effect is then found in
/// the next round, given the simpler shape: a table by position and direction holds every reversal, whether there is
/// one or not. Shapes are simpler if they have fewer columns; at most criteria.most_shapes are tried, the best ones.
std::optional<std::size_t> simpler_beside_effect(const Evidence& evidence, std::size_t shape);

} // namespace gumshoe::tracing
