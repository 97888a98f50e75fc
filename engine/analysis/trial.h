#pragma once
/// Expanded uncertainty as a function of the standard uncertainties of the inputs, by Monte Carlo with common random
/// numbers: a function of the scales, so that it can be solved.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "propagation/experiment.h"

namespace gumshoe::analysis {

class Trial {
public:
  /// Of one output; runs the model at that output's reading alone where the readings' labels allow it.
  Trial(const propagation::Experiment& experiment, std::size_t output, int threads);

  /// Variates, by name, that reach the output.
  const std::vector<std::size_t>& reaching() const { return reaching_; }
  const propagation::Experiment& experiment() const { return *experiment_; }

  /// Half the symmetric coverage interval when the deviations of variate v from its mean are multiplied by scale[v];
  /// infinite if more samples fail than the scenario allows.
  double expanded_uncertainty(const std::vector<double>& scale);

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
