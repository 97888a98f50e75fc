#pragma once
/// Samples computed again, compared with those that a file holds: its record knows a model by name, and not what a
/// program or a library of the model reads.
#include <functional>
#include <string>
#include <vector>

#include "propagation/experiment.h"
#include "propagation/shard.h"

namespace gumshoe::cli {

/// The outputs that a file holds, of samples in [first, last) of the run; SI, NaN where failed.
struct KeptOutputs {
  propagation::SampleRange samples;
  std::function<std::vector<double>(std::size_t output, std::uint64_t first, std::uint64_t count)> read;
};

/// How near two values must be to be the same: `bits` for this program's own models on one instruction set; `rounding`
/// for another instruction set, and for programs, which may print few digits.
enum class Same { bits, rounding };

/// The first output of `samples` whose value `now[output * samples.size() + i]` is not the one kept, in words: "y of
/// sample 5 is 2.1 in the file and 3.15 now", SI; empty if there is none.
std::string difference(const propagation::Experiment& experiment, const KeptOutputs& kept,
                       const propagation::SampleRange& samples, const std::vector<double>& now, Same same);

/// The same of the first samples that are kept: 64, or 8 of a model that is not this program's own, which may be slow.
std::string first_difference(const propagation::Experiment& experiment, const KeptOutputs& kept, Same same);

} // namespace gumshoe::cli
