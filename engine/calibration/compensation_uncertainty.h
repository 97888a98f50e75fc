#pragma once
/// u of the errors that a control corrects: by the sizes of effects, and by the declared quantities that these errors
/// depend on, directly or because the fit that gave the sizes held them.
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "calibration/compensation.h"
#include "propagation/experiment.h"
#include "quantities/correlations.h"

namespace gumshoe::calibration {

/// Variates of the plan other than the noise of indications, which are as many as the readings: the columns below.
struct Columns {
  std::vector<std::size_t> variates;   ///< ascending
  std::vector<std::size_t> of_variate; ///< by variate of the plan
  std::vector<std::size_t> quantities; ///< that have them, ascending
  explicit Columns(const propagation::Experiment& experiment);
};

/// By the law of propagation, SI. An error is what an indication loses when the sizes are at null.
class ErrorUncertainty {
public:
  struct OfMean {
    double u, u_of_sizes; ///< the second without declared quantities
  };

  /// @param with, without  estimates of every reading, and the same with the sizes at null
  /// @param sizes          quantities of the scenario
  /// @param all            with declared quantities; false: u is that of the sizes
  ErrorUncertainty(const propagation::Experiment& experiment, std::size_t indication, const propagation::Points& with,
                   const propagation::Points& without, const std::vector<std::size_t>& sizes, bool all);

  /// Of the mean of the errors at these readings.
  OfMean of_mean(const std::vector<std::size_t>& readings);
  /// Those that show in u of the means asked for, and those that are not in it; the largest first.
  std::vector<Compensation::Declared> declared() const;

private:
  Eigen::MatrixXd derivatives(const propagation::Points& at, const std::vector<std::size_t>& quantities) const;
  void add_held();
  double u_of(const Eigen::VectorXd& slope);
  Compensation::Declared& declared(std::size_t column);
  void note_declared(const Eigen::VectorXd& slope, const Eigen::VectorXd& of_sizes);

  const propagation::Experiment& e_;
  std::size_t indication_;
  bool all_;
  Columns columns_;
  quantities::Correlations correlations_;
  Eigen::MatrixXd by_size_, by_variate_; ///< derivatives of the errors, [reading][column]
  std::vector<std::size_t> fitted_;      ///< columns of values that an estimate gave
  std::vector<Compensation::Declared> declared_;
  double largest_ = 0; ///< u asked for
};

} // namespace gumshoe::calibration
