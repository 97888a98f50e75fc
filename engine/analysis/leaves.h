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

/// Calls body(part, first, count) for every part of [0, n): 65,536 each, the last one shorter. The division into parts
/// is fixed; the order of the calls is not, and they may run at the same time on up to `threads` threads.
template <class Body> void for_ranges(std::size_t n, int threads, const Body& body) {
  const auto one = [&](std::size_t part) {
    const std::size_t first = part * part_values;
    body(part, first, std::min(part_values, n - first));
  };
  if (threads == 1 || parts(n) == 1)
    for (std::size_t part = 0; part < parts(n); ++part) one(part);
  else
    propagation::parallel_for(parts(n), threads, one);
}

/// Calls body(part, values of the part) for the parts of x.
template <class Body> void for_parts(std::span<const double> x, int threads, const Body& body) {
  for_ranges(x.size(), threads,
             [&](std::size_t part, std::size_t first, std::size_t count) { body(part, x.subspan(first, count)); });
}

/// Sum of leaf(first, count) over leaves of 1,024 of [0, n), added pairwise in a fixed order. `Sum` is zero when
/// value-initialised and has operator+=; leaf must depend on its range only.
template <class Sum, class Leaf> Sum leaf_sum(std::size_t n, int threads, const Leaf& leaf) {
  std::vector<Sum> sums((n + leaf_values - 1) / leaf_values);
  for_ranges(n, threads, [&](std::size_t, std::size_t first, std::size_t count) {
    for (std::size_t at = 0; at < count; at += leaf_values)
      sums[(first + at) / leaf_values] = leaf(first + at, std::min(leaf_values, count - at));
  });
  if (sums.empty()) return {};
  for (std::size_t width = 1; width < sums.size(); width *= 2)
    for (std::size_t i = 0; i + width < sums.size(); i += 2 * width) sums[i] += sums[i + width];
  return sums[0];
}

/// The same over leaf(values).
template <class Sum, class Leaf> Sum leaf_sum(std::span<const double> x, int threads, const Leaf& leaf) {
  return leaf_sum<Sum>(x.size(), threads,
                       [&](std::size_t first, std::size_t count) { return leaf(x.subspan(first, count)); });
}

} // namespace gumshoe::analysis
