#pragma once
/// Sizes from which one effect is fitted where readings jump with it.
#include <optional>
#include <vector>

#include "tracing/candidates/candidates.h"

namespace gumshoe::tracing {

/// Sizes that were tried, and what the exact model leaves with each, such that its squares are those left (reduced).
class Starts {
public:
  /// @param none        what no size leaves
  /// @param amplitudes  of a set of sizes
  /// @param freedom     degrees of freedom of what is left
  Starts(Vector none, Index amplitudes, double freedom);
  /// @param at  sets of sizes (columns)   @param valid  false where the model has no value
  void add(const Matrix& at, const Matrix& reduced, const std::vector<bool>& valid);
  /// Sizes at random within about a step of each of the best (criteria.h). `batch` keys the numbers.
  Matrix between_best(double step, int batch) const;
  /// 2 ln L of the best over no size; zero if the model has no value anywhere.
  double ratio() const;
  /// The best; none if the model has no value anywhere.
  std::optional<Start> best() const;

private:
  /// Number of independent sizes for which they count: one, and the turns along the minimum spanning tree of their
  /// signatures, each with at most one.
  double turns() const;
  std::vector<Index> moving() const; ///< places of the valid sizes that change what is left

  Vector none_;
  double freedom_;
  Matrix at_;
  Matrix moved_; ///< what each takes from that which no size leaves
  std::vector<double> left_;
};

} // namespace gumshoe::tracing
