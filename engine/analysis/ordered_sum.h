#pragma once
/// Sums whose bits depend on neither threads nor block size.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace gumshoe::analysis {

/// Sum of term(i), i < n: over fixed leaves of 1,024 terms in order, then pairwise over the leaves' sums.
template <class Term> double ordered_sum(std::size_t n, const Term& term) {
  constexpr std::size_t leaf = 1024;
  std::vector<double> sums;
  for (std::size_t at = 0; at < n; at += leaf) {
    double sum = 0;
    for (std::size_t i = at; i < std::min(at + leaf, n); ++i) sum += term(i);
    sums.push_back(sum);
  }
  if (sums.empty()) return 0;
  for (std::size_t width = 1; width < sums.size(); width *= 2)
    for (std::size_t i = 0; i + width < sums.size(); i += 2 * width) sums[i] += sums[i + width];
  return sums[0];
}

} // namespace gumshoe::analysis
