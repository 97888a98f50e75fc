#pragma once
/// Parallel passes over many values. The bits of a result do not depend on the number of threads.
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "propagation/propagate.h"

namespace gumshoe::analysis {

/// Values per leaf of a sum: fixed, because it decides the bits.
inline constexpr std::size_t leaf_values = 1024;
inline constexpr std::size_t part_values = 64 * leaf_values; ///< what one task takes

/// Number of parts of n values.
inline std::size_t parts(std::size_t n) { return (n + part_values - 1) / part_values; }

/// Calls body(part, values of the part) for every part of 65,536 values, the last one shorter. The division into parts is
/// fixed; the order of the calls is not, and they may run at the same time on up to `threads` threads.
template <class Body> void for_parts(std::span<const double> x, int threads, const Body& body) {
  const auto one = [&](std::size_t part) {
    const std::size_t first = part * part_values;
    body(part, x.subspan(first, std::min(part_values, x.size() - first)));
  };
  if (threads == 1 || parts(x.size()) == 1)
    for (std::size_t part = 0; part < parts(x.size()); ++part) one(part);
  else
    propagation::parallel_for(parts(x.size()), threads, one);
}

/// Sum of leaf(values) over leaves of 1,024 values, added pairwise in a fixed order. `Sum` is zero when default-constructed
/// and has operator+=; leaf must depend on its values only.
template <class Sum, class Leaf> Sum leaf_sum(std::span<const double> x, int threads, const Leaf& leaf) {
  std::vector<Sum> sums((x.size() + leaf_values - 1) / leaf_values);
  for_parts(x, threads, [&](std::size_t part, std::span<const double> some) {
    for (std::size_t at = 0; at < some.size(); at += leaf_values)
      sums[(part * part_values + at) / leaf_values] = leaf(some.subspan(at, std::min(leaf_values, some.size() - at)));
  });
  if (sums.empty()) return {};
  for (std::size_t width = 1; width < sums.size(); width *= 2)
    for (std::size_t i = 0; i + width < sums.size(); i += 2 * width) sums[i] += sums[i + width];
  return sums[0];
}

} // namespace gumshoe::analysis
