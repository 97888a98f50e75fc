#pragma once
/// Draws of some variates given the others, under the plan's Gaussian copulas and multivariate t distributions.
#include <cstdint>
#include <memory>
#include <vector>

#include "quantities/sample_plan.h"

namespace gumshoe::analysis {

/// Two independent draws A and B of all variates, and mixtures: the frozen variates from A, the others from their
/// conditional distribution given those. Random numbers of their own, of purpose pick-freeze.
class ConditionalDraws {
public:
  explicit ConditionalDraws(const quantities::SamplePlan& plan);
  ~ConditionalDraws();

  /// A block of rows, [variate * rows + i].
  struct Block {
    std::size_t rows = 0;
    /// Normal scores for tied variates, deviations for the others; then W of each group (quantities::CopulaGroup).
    std::vector<double> scores_a, scores_b;
    std::vector<double> a, b;               ///< deviations
    std::vector<double> mixed;
  };
  /// first is a multiple of 64, rows of 8.
  Block draw(std::uint64_t first, std::size_t rows) const;

  /// Fills rows [from, from + count) of `mixed`, multiples of 8. In a copula group with correlation matrix R, free
  /// scores are z_B + R_UF R_FF^-1 (z_A - z_B)_F, U free and F frozen: exactly normal with the conditional mean and
  /// covariance given z_A at F, since z_B at U less its regression on z_B at F does not depend on the latter.
  void mix(Block& block, const std::vector<bool>& frozen, std::size_t from, std::size_t count) const;

private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

} // namespace gumshoe::analysis
