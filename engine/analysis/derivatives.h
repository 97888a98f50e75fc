#pragma once
/// Derivatives of one reading's measurands by its quantities: exact where the model has them, else by differences.
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Derivatives of one measurand at one reading by every quantity of the scenario (model, effects, indications, sizes),
/// SI.
struct Derivatives {
  Status status = Status::ok;
  double value = 0;
  std::vector<double> first;        ///< [quantity]
  std::vector<double> second;       ///< [quantity][quantity], if requested
  std::vector<bool> differentiable; ///< [quantity]
  bool exact = true;                ///< false: differences, with NaN for quantities that do not vary at this reading
  std::vector<double> third;        ///< [i][j]: d^3 f / dx_i dx_j^2, computed with `second` if not exact
};

/// Derivatives of every measurand at the given point (Experiment::point), in one evaluation of the model for all of
/// them. `second` costs a pass per pair of chunks of 8 quantities.
std::vector<Derivatives> differentiate(const propagation::Experiment& experiment, std::size_t reading,
                                       const std::vector<double>& point, bool second);
/// The same of one measurand.
Derivatives differentiate(const propagation::Experiment& experiment, std::size_t reading, std::size_t measurand,
                          const std::vector<double>& point, bool second);

} // namespace gumshoe::analysis
