#pragma once
/// From samples to everything a run says.
#include <functional>
#include <span>

#include "analysis/results.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Where the samples are: values of output row `o` over the whole run, NaN where failed.
struct Samples {
  std::function<std::vector<double>(std::size_t output)> values;
  std::function<std::vector<std::uint8_t>()> status;
  /// The same where they are, if they are in memory; else empty, or unset.
  std::function<std::span<const double>(std::size_t output)> in_memory = {};
};

/// Summaries, budgets, validation, sensitivity, comparisons, printed values and statements.
Results analyse(const propagation::Experiment& experiment, const Samples& samples, int threads);

/// The result in GUM words (7.2), one sentence or two, rounded by 7.2.6, in the unit shown to people.
/// A GUM interval that the Monte Carlo method does not validate says so.
std::string statement(const Summary& summary, const Budget& budget, const Validation& validation,
                      double coverage_probability, bool virtual_experiment);

} // namespace gumshoe::analysis
