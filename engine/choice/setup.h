#pragma once
/// A setting made ready to run, and its errors.
#include <functional>
#include <memory>

#include "choice/results.h"
#include "propagation/experiment.h"

namespace gumshoe::choice {

/// The scenario with these settings; nothing else changes, so that equal quantities keep their random numbers.
scenario::Scenario with(const scenario::Scenario& scenario, const std::vector<scenario::Setting>& settings);

class Setup {
public:
  /// Throws InputError if the setting cannot be: an evaluation of a single reading with several, a time that is none.
  Setup(const scenario::Scenario& scenario, const std::vector<scenario::Setting>& settings);

  const propagation::Experiment& experiment() const { return *experiment_; }
  std::size_t output() const { return output_; }
  double seconds() const { return seconds_; }

  /// Errors of samples [first, first + n): out[0] with all quantities drawn, out[1 + k] in case k. NaN where failed.
  /// first is a multiple of 64, n of 8.
  void errors(std::uint64_t first, std::size_t n, quantities::Purpose purpose, const std::vector<double*>& out) const;

private:
  std::unique_ptr<scenario::Scenario> scenario_; ///< an Experiment refers to its scenario
  std::unique_ptr<propagation::Experiment> experiment_;
  std::unique_ptr<quantities::Sampler> sampler_;
  std::size_t output_ = 0;
  double seconds_ = 0;
};

/// Errors of all setups: [setup][0: all drawn, 1 + k: case k][sample].
using Errors = std::vector<std::vector<std::vector<double>>>;
Errors errors(const std::vector<const Setup*>& setups, std::uint64_t samples, quantities::Purpose purpose, int threads);

} // namespace gumshoe::choice
