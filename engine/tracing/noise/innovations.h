#pragma once
/// Whitens rows with random effects that each change a few rows: one row after the other, given the estimate of the
/// effects from the rows before (innovations; Kalman, J. Basic Eng. 82 (1960) 35). With x = Z b + e, b and e of unit
/// variance, this solves by the Cholesky factor of I + Z Z' without forming it. The work grows with the number of
/// effects that are open at the same time, not with their total.
#include <utility>
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

class Innovations {
public:
  /// Effects that change each row, with their loadings.
  using Rows = std::vector<std::vector<std::pair<std::size_t, double>>>;

  explicit Innovations(const Rows& z);
  /// x' is [column][row]: L^-1 x in place.
  void whiten(Matrix& transposed) const;
  double log_determinant() const { return log_determinant_; } ///< of I + Z Z'

private:
  /// An effect occupies a slot from the first row that it changes to the last.
  struct Row {
    std::vector<Index> opened;
    std::vector<std::pair<Index, double>> moved, gain; ///< slot and factor
    double scale = 1;                                  ///< one over the innovation's standard deviation
  };
  std::vector<Row> rows_;
  Index slots_ = 0;
  double log_determinant_ = 0;
};

} // namespace gumshoe::tracing
