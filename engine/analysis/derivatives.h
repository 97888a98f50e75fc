#pragma once
/// Derivatives of one reading's measurands by its quantities: exact where the model has them, else by differences.
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Of measurand m at a reading, by every quantity of the scenario (model, effects, indications, sizes), SI.
struct Derivatives {
  Status status = Status::ok;
  double value = 0;
  std::vector<double> first;        ///< [quantity]
  std::vector<double> second;       ///< [quantity][quantity], if asked for
  std::vector<bool> differentiable; ///< [quantity]
  bool exact = true;                ///< false: by differences; then NaN by quantities that do not vary at this reading
  std::vector<double> third;        ///< [i][j]: d^3 f / dx_i dx_j^2, beside `second` if not exact
};

/// At the given point (Experiment::point). `second` costs a pass per pair of chunks of 8 quantities.
Derivatives differentiate(const propagation::Experiment& experiment, std::size_t reading, std::size_t measurand,
                          const std::vector<double>& point, bool second);

} // namespace gumshoe::analysis
