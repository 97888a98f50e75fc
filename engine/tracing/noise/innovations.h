#pragma once
/// Whitens rows that random effects move, each a few of them: one row after the other, given what the rows before say
/// of the effects (innovations; Kalman, J. Basic Eng. 82 (1960) 35). With x = Z b + e, b and e of unit variance, this
/// solves by the Cholesky factor of I + Z Z' without forming it: the work grows with the effects that are open at once,
/// not with all of them.
#include <utility>
#include <vector>

#include "tracing/matrix.h"

namespace gumshoe::tracing {

class Innovations {
public:
  /// By row: effects that move it, and by how much.
  using Rows = std::vector<std::vector<std::pair<std::size_t, double>>>;

  explicit Innovations(const Rows& z);
  /// x' is [column][row]: L^-1 x in place.
  void whiten(Matrix& transposed) const;
  double log_determinant() const { return log_determinant_; } ///< of I + Z Z'

private:
  /// An effect takes a slot with the first row that it moves and leaves it with the last.
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
