#pragma once
/// Eliminates the unknowns of sparse rows, by Givens rotations of one row after the other (George and Heath, Linear
/// Algebra Appl. 34 (1980) 69). Unknowns go in the order of the last rows that they move, so that the work grows with
/// the number of those that are open at the same time, not with their total.
#include <utility>
#include <vector>

#include "tracing/matrix.h"
#include "tracing/noise/elimination_kernels.h"

namespace gumshoe::tracing {

/// Columns that one row holds, with their values.
using SparseRow = std::vector<std::pair<std::size_t, double>>;

/// Correlation of rows with those a lag before them: of readings with those just before.
struct Serial {
  double correlation = 0;
  std::size_t lag = 1;
};
/// Rows without that correlation.
std::vector<SparseRow> decorrelated(const std::vector<SparseRow>& rows, const Serial& serial);

/// x is rows x any, correlated. With both made uncorrelated, P projects off the columns, of which all but the `free`
/// first have a unit row, 0 = coefficient, too.
class Elimination {
public:
  /// @param negligible  what is left of an entry below this counts as zero; by default its square is none
  Elimination(const std::vector<SparseRow>& rows, std::size_t columns, std::size_t free, const Serial& serial = {},
              double negligible = 1e-140);

  /// What is left of products: reduced(a)' reduced(b) = a'Pb.
  Matrix reduced(Matrix x) const;
  /// Sum of squares of each column of reduced(x).
  Vector squares(const Matrix& x) const;
  /// a' projected(b) = reduced(a)' reduced(b). P x, what the columns leave of each row, if rows are not correlated.
  Matrix projected(Matrix x) const;
  /// Coefficients of the columns that fit x best, columns x any; 0 where the rows do not determine one.
  Matrix solved(const Matrix& x) const;
  /// Inverse of the normal matrix, its first `count` rows and columns.
  Matrix covariance(Index count) const;
  /// ln |R[j, j]| of the triangular factor.
  double log_pivot(std::size_t column) const { return log_pivot_[column]; }
  /// Columns of which those eliminated before leave no more than this length, ascending.
  std::vector<std::size_t> explained(double length) const;

private:
  /// A row of the triangular factor R.
  struct Pivot {
    Index column = 0;
    double value = 0;
    std::vector<std::pair<Index, double>> right; ///< columns that are eliminated later
  };
  class Open;
  EliminationPlan plan() const;
  std::vector<double> state() const; ///< room for the kernels
  /// Calls body(first, count, block) for some columns at a time; `block` is lanes x rows, transposed.
  template <class Body> void by_blocks(const Matrix& x, const Body& body) const;
  using ByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  void substitute(ByRow& x) const;            ///< R^-1 x in place
  void substitute_transposed(ByRow& x) const; ///< R'^-1 x in place

  Serial serial_;
  double negligible_;
  std::size_t columns_ = 0, slots_ = 0;
  std::vector<double> log_pivot_;
  std::vector<Pivot> pivots_; ///< in the order of elimination
  std::vector<std::uint32_t> opened_, opened_end_, slot_, rotation_end_, closed_, closed_end_;
  std::vector<double> cosine_, sine_;
};

} // namespace gumshoe::tracing
