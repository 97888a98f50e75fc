#pragma once
/// The samples of a run, wherever they are kept.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gumshoe::analysis {

using ValuesOf = std::function<std::vector<double>(std::size_t output)>;

/// Values are SI, in sample order, NaN where a sample failed.
struct Samples {
  ValuesOf values;
  std::function<std::vector<std::uint8_t>()> status;
  /// The values of an output without a copy, if they are in memory; unset or empty otherwise.
  std::function<std::span<const double>(std::size_t output)> in_memory = {};

  /// The values of an output: as they lie in memory, or copied into `room`.
  std::span<const double> view(std::size_t output, std::vector<double>& room) const {
    std::span<const double> found;
    if (in_memory) found = in_memory(output);
    return found.empty() ? room = values(output) : found;
  }
};

} // namespace gumshoe::analysis
