#include "cli/recomputed.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "propagation/propagate.h"

namespace gumshoe::cli {
namespace {

constexpr std::uint64_t window = 64; ///< samples whose spread is the scale of an output

/// What may be rounding, in addition to a share of the value: a share of the spread of the samples around.
double rounding_of(const KeptOutputs& kept, std::size_t output, std::uint64_t sample) {
  const std::uint64_t first = std::max(kept.samples.first, sample / window * window);
  double low = INFINITY, high = -INFINITY;
  for (const double x : kept.read(output, first, std::min(window, kept.samples.last - first)))
    low = std::fmin(low, x), high = std::fmax(high, x);
  return high > low ? 1e-6 * (high - low) : 0;
}

} // namespace

std::string difference(const propagation::Experiment& e, const KeptOutputs& kept,
                       const propagation::SampleRange& samples, const std::vector<double>& now, Same same) {
  const auto n = static_cast<std::size_t>(samples.size());
  for (std::size_t o = 0; o < e.outputs().size(); ++o) {
    const std::vector<double> before = kept.read(o, samples.first, n);
    const double rounding = same == Same::bits ? 0 : rounding_of(kept, o, samples.first);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = now[o * n + i], most = same == Same::bits ? 0 : 1e-12 * std::fabs(x) + rounding;
      if (std::isnan(x) ? std::isnan(before[i]) : std::fabs(x - before[i]) <= most) continue;
      return fmt::format("{} of sample {} is {:.17g} in the file and {:.17g} now", e.outputs()[o].name,
                         samples.first + i, before[i], x);
    }
  }
  return {};
}

std::string first_difference(const propagation::Experiment& e, const KeptOutputs& kept, Same same) {
  const std::uint64_t most = e.scenario().external.empty() ? window : 8, first = kept.samples.first;
  const propagation::SampleRange samples{first, std::min(kept.samples.last, first + most)};
  const propagation::ResultBlock block = propagation::block_maker(e)(samples.first, samples.last);
  return difference(e, kept, samples, block.outputs, same);
}

} // namespace gumshoe::cli
