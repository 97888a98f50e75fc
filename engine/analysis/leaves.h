#pragma once
/// Parallel passes over many values. The bits of a result do not depend on the number of threads.
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/column.h"
#include "propagation/propagate.h"

namespace gumshoe::analysis {

/// Values per leaf of a sum: fixed, because it decides the bits.
inline constexpr std::size_t leaf_values = 1024;
inline constexpr std::size_t part_values = 64 * leaf_values; ///< what one task takes
inline constexpr std::size_t piece_values = 8 * leaf_values; ///< what is read at once: 64 KiB

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

/// Calls body(values) for the pieces of [first, first + count) of x, in order; `first` is a multiple of a leaf.
template <class Body>
void for_pieces(const Column& x, std::size_t first, std::size_t count, Room& room, const Body& body) {
  const std::size_t piece = x.in_memory() ? part_values : piece_values;
  for (std::size_t at = 0; at < count; at += piece) body(x.read(first + at, std::min(piece, count - at), room));
}

/// Calls body(part, values) for the parts of x, of each part once or, piece by piece in order, several times.
template <class Body> void for_parts(const Column& x, int threads, const Body& body) {
  for_ranges(x.size(), threads, [&](std::size_t part, std::size_t first, std::size_t count) {
    Room room;
    for_pieces(x, first, count, room, [&](std::span<const double> some) { body(part, some); });
  });
}

/// Adds sums pairwise in a fixed order; 0 if there are none. Changes them.
template <class Sum> Sum pairwise(std::span<Sum> sums) {
  if (sums.empty()) return {};
  for (std::size_t width = 1; width < sums.size(); width *= 2)
    for (std::size_t i = 0; i + width < sums.size(); i += 2 * width) sums[i] += sums[i + width];
  return sums[0];
}

/// Sum of leaf(first, count) over leaves of 1,024 of [0, n), added pairwise in a fixed order. `Sum` is zero when
/// value-initialised and has operator+=; leaf must depend on its range only. The leaves of a part are a subtree of the
/// pairwise sums, so that one sum a part is kept.
template <class Sum, class Leaf> Sum leaf_sum(std::size_t n, int threads, const Leaf& leaf) {
  std::vector<Sum> sums(parts(n));
  for_ranges(n, threads, [&](std::size_t part, std::size_t first, std::size_t count) {
    std::array<Sum, part_values / leaf_values> leaves;
    std::size_t used = 0;
    for (std::size_t at = 0; at < count; at += leaf_values)
      leaves[used++] = leaf(first + at, std::min(leaf_values, count - at));
    sums[part] = pairwise(std::span(leaves).first(used));
  });
  return pairwise(std::span(sums));
}

/// Sum of term(i) for i < n, on one thread, with the same bits.
template <class Term> double sum_of(std::size_t n, const Term& term) {
  return leaf_sum<double>(n, 1, [&](std::size_t first, std::size_t count) {
    double sum = 0;
    for (std::size_t i = first; i < first + count; ++i) sum += term(i);
    return sum;
  });
}

/// The same over leaf(values).
template <class Sum, class Leaf> Sum leaf_sum(const Column& x, int threads, const Leaf& leaf) {
  std::vector<Sum> sums(parts(x.size()));
  for_ranges(x.size(), threads, [&](std::size_t part, std::size_t first, std::size_t count) {
    std::array<Sum, part_values / leaf_values> leaves;
    std::size_t used = 0;
    Room room;
    for_pieces(x, first, count, room, [&](std::span<const double> some) {
      for (std::size_t at = 0; at < some.size(); at += leaf_values)
        leaves[used++] = leaf(some.subspan(at, std::min(leaf_values, some.size() - at)));
    });
    sums[part] = pairwise(std::span(leaves).first(used));
  });
  return pairwise(std::span(sums));
}

} // namespace gumshoe::analysis
