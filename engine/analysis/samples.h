#pragma once
/// The samples of a run, wherever they are kept.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>

#include "analysis/column.h"
#include "base/progress.h"
#include "propagation/memory_store.h"
#include "propagation/parallel.h"

namespace gumshoe::analysis {

/// The values of an output: SI, in sample order, NaN where a sample failed.
using ValuesOf = std::function<Column(std::size_t output)>;

/// Read part by part, on several threads at the same time.
struct Samples {
  ValuesOf values;
  std::size_t size = 0; ///< of every output
  /// Writes the status of samples [first, first + out.size()).
  std::function<void(std::size_t first, std::span<std::uint8_t> out)> status;
};

/// Samples in memory, where they lie.
inline Samples view_of(const propagation::MemoryStore& store) {
  return {[&store](std::size_t output) { return Column(store.values(output)); }, store.status().size(),
          [&store](std::size_t first, std::span<std::uint8_t> out) {
            std::ranges::copy(store.status().subspan(first, out.size()), out.begin());
          }};
}

/// So many values at the most are read once and held, 16 MiB; more are read anew by every pass.
inline constexpr std::size_t held_values = std::size_t{1} << 21;
inline Column held(const Column& column, Room& room, std::size_t columns = 1) {
  return column.in_memory() || columns * column.size() > held_values ? column
                                                                     : Column(column.read(0, column.size(), room));
}

/// Calls body(i) for i in [0, n), which passes over so many values: as many at the same time as is held in bounded
/// memory, and two of however many values, so that the passes of one fill the pauses between those of the other. 0
/// threads: all processors.
inline void side_by_side(std::size_t n, std::size_t values, int threads, const std::function<void(std::size_t)>& body) {
  constexpr std::size_t least = 2;
  const std::size_t most = std::max(least, held_values / std::max<std::size_t>(1, values));
  progress::Loop loop(n);
  for (std::size_t first = 0; first < n; first += most)
    propagation::parallel_for(std::min(most, n - first), threads, [&](std::size_t i) {
      body(first + i);
      loop.step();
    });
}

} // namespace gumshoe::analysis
