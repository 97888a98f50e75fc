#pragma once
/// Passes over many values in parallel, whose results' bits do not depend on the number of threads.
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "propagation/propagate.h"

namespace gumshoe::analysis {

inline constexpr std::size_t leaf_values = 1024;
inline constexpr std::size_t part_values = 64 * leaf_values; ///< what one task takes

inline std::size_t parts(std::size_t n) { return (n + part_values - 1) / part_values; }

/// body(part, its values) for every part; parts are fixed, their order is not.
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

/// leaf(values) for every leaf of 1,024, added up pairwise in order. Sum: default is zero, has +=.
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
