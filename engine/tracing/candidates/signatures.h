#pragma once
/// Signatures: change of the indications with each quantity, at a point.
#include "tracing/simulator.h"

namespace gumshoe::tracing {

/// Signatures of every quantity of the model and of its effects; rows as the simulator's.
struct Signatures {
  Matrix tangents;           ///< [row][quantity]: exact derivatives
  Matrix secants;            ///< [row][2 quantity + i]: slopes over sizes[2 quantity + i], i = 0 upwards, 1 downwards
  std::vector<double> sizes; ///< SI; 0: no secant
  std::vector<std::vector<bool>> changes_with; ///< [quantity][condition]: whether its tangent changes with it
};

/// Computes them at a point. Only amplitudes of effects have secants, over steps that move the indications by about
/// `step` (SI).
Signatures signatures(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                      double step);

} // namespace gumshoe::tracing
