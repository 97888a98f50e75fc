#pragma once
/// Sums whose bits depend on neither threads nor block size.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace gumshoe::analysis {

/// Sum of term(i) for i < n; 0 if n is 0.
///
/// Leaves of 1,024 terms are summed in order, then the sums of the leaves pairwise, so that the rounding error grows with
/// log n and the bits are those of any other block size or number of threads.
/// Source: Higham, Accuracy and Stability of Numerical Algorithms, section 4.2.
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
