#pragma once
/// Pure error: the scatter of readings whose conditions come back; and lack of fit, what comes back with them.
///
/// A whitened residual of cell c in pass b is m_c + (drift) + e, where m_c is any function of the cell. The pure error
/// is what is left when these are projected out together: the model's own columns and its declared draws; a constant
/// and, from four readings of a cell on, a straight line in time for every cell; a constant and a straight line for
/// every pass. So neither what repeats nor a slow drift counts, even one that differs from cell to cell. Readings
/// beyond criteria.winsor_limit robust standard deviations are left out, each with its degree of freedom. The lack of
/// fit is what the cells' constants take.
#include <functional>

#include "tracing/noise/projection.h"
#include "tracing/noise/replicates.h"
#include "tracing/noise/sparse_columns.h"

namespace gumshoe::tracing {

/// "Chosen rows" are those given to the constructor. Keeps a reference to the design.
class PureError {
public:
  /// @param model  its variance component, if it has one, counts among what is projected out
  PureError(const Design& design, const std::vector<Index>& rows, const Replicates& replicates, int threads,
            const CovarianceModel& model = {});

  /// False if too few readings repeat: no other function may be called.
  bool known() const { return freedom() >= least_freedom(); }
  double freedom() const { return freedom(pure_); }
  std::size_t cells() const { return cells_; }
  /// Standard deviation of the pure error of each column (chosen rows, SI), in units of the design's noise.
  Vector scale(const Matrix& residuals) const;
  /// The same of one residual by indication, each with its share of the degrees of freedom.
  Vector scale_by_indication(const Vector& residual) const;
  /// n ln of the sum of squares without over that with the cells' constants, by column of residuals.
  Vector lack_of_fit(const Matrix& residuals) const;
  /// Root mean square of what repeats in one residual, in units of the design's noise; less what the pure error gives.
  double repeats(const Vector& residual) const;
  /// Whitened residuals about the model and the constants of cells (if known) and blocks.
  Matrix about_cells(const Matrix& residuals) const;
  /// Places, among the chosen rows, of readings that stand out from the others of their cell and pass.
  std::vector<Index> outlying(const Vector& residual) const;
  /// Factors without which what repeats is no longer described.
  std::vector<std::string> depends_on(const Vector& residual) const;
  /// Cells that distinguish no factor of which one residual shows no trace (F test by criteria.idle_factor), so that
  /// more readings share one. May be called if too few repeat.
  Replicates without_idle_factors(const Vector& residual) const;

private:
  static double least_freedom();
  double freedom(const Projection& p) const { return static_cast<double>(rows_.size() - p.rank()); }
  Matrix whitened(const Matrix& residuals) const;
  struct Cleaned {
    Matrix data;    ///< whitened; outlying readings replaced by what the others of their cell and pass say
    Vector squares; ///< by column: sum of squares of its pure error
    Vector freedom; ///< by column
  };
  Cleaned cleaned(const Matrix& residuals) const;
  /// Places of all readings of one's cell, in their order.
  std::vector<Index> cell_mates(Index row) const;
  void clean(Matrix& data, Vector& squares, Vector& freedom) const;
  /// Squares that a projection leaves of each column.
  Vector squares(const Projection& projection, const Matrix& data) const;
  Projection without(const SparseColumns& columns) const;
  /// Calls body(first, count) for some of so many data sets at a time, on several threads.
  void by_sets(Index sets, const std::function<void(Index, Index)>& body) const;

  const Design& design_;
  std::vector<Index> rows_;
  const Replicates& replicates_;
  int threads_;
  std::size_t cells_ = 0;
  std::vector<std::vector<Index>> orders_; ///< of the chosen rows: as measured, and cell by cell
  std::vector<Index> together_;            ///< places of readings that are not the only one of their cell
  SparseColumns nuisance_;                 ///< the model's columns and, where they are blocks, constants of passes
  Projection without_, with_, pure_;       ///< without and with the cells' constants; with all that drifts, too
};

} // namespace gumshoe::tracing
