#pragma once
/// How values that `gumshoe estimate` gave depend on the declared quantities that it held.
#include <string>
#include <vector>

#include <Eigen/Core>

#include "propagation/experiment.h"

namespace gumshoe::calibration {

/// Variates of the plan other than the noise of indications, which are as many as the readings: the columns below.
struct Columns {
  std::vector<std::size_t> variates;   ///< ascending
  std::vector<std::size_t> of_variate; ///< by variate of the plan
  std::vector<std::size_t> quantities; ///< that have them, ascending
  explicit Columns(const propagation::Experiment& experiment);
};

/// Derivatives of the indications by the variates of these quantities, SI, at these points; rows are
/// [reading][indication], columns of other quantities are zero.
Eigen::MatrixXd indications_by_variate(const propagation::Experiment& experiment, const Columns& columns,
                                       const propagation::Points& at, const std::vector<std::size_t>& quantities);

struct Held {
  std::vector<std::size_t> fitted, held; ///< columns
  /// Derivative of each fitted value by each held one, [fitted][held], SI; empty where the scenario no longer has the
  /// readings or their noise, by which the fit weighed them.
  Eigen::MatrixXd slopes;
};

/// The fit is the one that wrote the scenario: with the covariance C of its values, weights W and derivatives J by the
/// fitted and K by the held variates, a change of these moves the values by -C J' W K (exact with the squared loss,
/// priors included). Held variates that a correlation ties to fitted ones are no part of it: the covariance has them.
Held held_by_fit(const propagation::Experiment& experiment, const Columns& columns);

} // namespace gumshoe::calibration
