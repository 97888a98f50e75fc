#pragma once
/// Two effects that hide each other.
#include <array>
#include <optional>

#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

/// The two candidates, by their places, that explain most together, where each counts given the other and both explain
/// more than shapes do, and more than the best two of as many explain of noise alone; none if there are no such two.
/// What one part alone has is not among them.
/// @param best_shape  score of the best shape
/// @param alpha       probability of a pair in noise alone
std::optional<std::array<std::size_t, 2>> hidden_pair(const Evidence& evidence, double best_shape, double alpha);

} // namespace gumshoe::tracing
