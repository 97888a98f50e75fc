#pragma once
/// Expanded uncertainty of one output as a function of the standard uncertainties of its inputs, by Monte Carlo with common
/// random numbers. With the draws held fixed it is a deterministic function of the scales, so that equations in it can be
/// solved (analysis/target).
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

class Trial {
public:
  /// Prepares the draws for one output. Where all readings have the same kinds of labels, the model runs at the reading of
  /// that output alone. Takes at most 100,000 samples.
  Trial(const propagation::Experiment& experiment, std::size_t output, int threads);

  /// Indices of the input draws (variates) that the output depends on.
  const std::vector<std::size_t>& reaching() const { return reaching_; }
  const propagation::Experiment& experiment() const { return *experiment_; }

  /// Half-width of the interval about the mean that has the coverage probability, SI: the U of a result (summary.h).
  ///
  /// @param scale by variate: factor on its deviations from its mean, 1 for the uncertainty as declared, 0 for none
  /// @return      infinite if more samples fail than `max_failed_share` allows
  double expanded_uncertainty(const std::vector<double>& scale);

  /// Samples per run, and model runs so far.
  std::size_t points() const { return points_; }
  std::size_t runs() const { return runs_; }

private:
  std::unique_ptr<scenario::Scenario> scenario_; ///< an Experiment refers to its scenario
  std::unique_ptr<propagation::Experiment> experiment_;
  std::size_t row_ = 0, points_ = 0, runs_ = 0;
  int threads_ = 0;
  std::vector<std::size_t> reaching_;
  std::vector<double> drawn_, means_;
};

} // namespace gumshoe::analysis
