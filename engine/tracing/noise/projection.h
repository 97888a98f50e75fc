#pragma once
/// Projects off columns of few rows each, whatever their rank.
#include <optional>
#include <vector>

#include "tracing/noise/elimination.h"

namespace gumshoe::tracing {

class Projection {
public:
  Projection() = default;
  /// @param orders  orders of all rows; they are eliminated in the one in which fewest columns are open together
  Projection(const std::vector<SparseRow>& rows, std::size_t columns, const std::vector<std::vector<Index>>& orders);

  /// What the columns leave of x.
  Matrix operator()(const Matrix& x) const;
  /// Sum of squares of each column of that.
  Vector squares(const Matrix& x) const;
  std::size_t rank() const { return rank_; }

private:
  std::vector<Index> order_;
  std::optional<Elimination> elimination_;
  std::size_t rank_ = 0;
};

} // namespace gumshoe::tracing
