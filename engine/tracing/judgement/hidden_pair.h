#pragma once
/// Two effects that hide each other.
#include <array>
#include <optional>

#include "tracing/judgement/evidence.h"

namespace gumshoe::tracing {

struct HiddenPair {
  std::array<std::size_t, 2> candidates; ///< by their places
  double p_value = 1; ///< probability that the best pair of noise alone exceeds its limits by as much
};

/// The two candidates that explain most together, where each counts given the other and both explain
/// more than shapes do, and more than the best two of as many explain of noise alone; none if there are no such two.
/// What one part alone has is not among them.
/// @param best_shape  score of the best shape
/// @param alpha       probability of a pair in noise alone
std::optional<HiddenPair> hidden_pair(const Evidence& evidence, double best_shape, double alpha);

} // namespace gumshoe::tracing
