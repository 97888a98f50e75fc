#pragma once
/// Matrices of the traced fit, and conversion between their indices and those of containers.
#include <cstddef>

#include <Eigen/Core>

namespace gumshoe::tracing {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Converts an index between matrices and containers.
constexpr Index index(std::size_t i) { return static_cast<Index>(i); }
constexpr std::size_t index(Index i) { return static_cast<std::size_t>(i); }
constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

} // namespace gumshoe::tracing
