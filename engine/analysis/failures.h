#pragma once
/// Samples without a value: how many, why, and where among the inputs they lie.
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

struct Failures {
  std::uint64_t samples = 0;
  /// One sentence per reason: "never_covered: 120 samples, the first is sample 345 (...); beam_pitch is 3.1 to 4.7 deg
  /// in them, as in 1.3 % of all samples". An input is named where the failed samples, 20 or more, span a range that
  /// holds less than half of all samples; at most three are, the narrowest range first. Inputs are drawn again for it.
  std::vector<std::string> reasons;
};

Failures failures_of(const propagation::Experiment& experiment, const Samples& samples);

} // namespace gumshoe::analysis
