#pragma once
/// Pure error: the scatter of readings whose conditions come back; and lack of fit, what comes back with them.
///
/// A whitened residual of cell c in pass b is m_c + (drift) + e, where m_c is any function of the cell. The pure error
/// is what is left when these are projected out together: the model's own columns and its declared draws; a constant
/// and, from four readings of a cell on, a straight line in time for every cell; a constant and a straight line for
/// every pass. So neither what repeats nor a slow drift counts, even one that differs from cell to cell. Readings
/// beyond criteria.winsor_limit robust standard deviations are left out, each with its degree of freedom. The lack of
/// fit is what the cells' constants take.
#include "tracing/noise/replicates.h"
#include "tracing/noise/whitened.h"

namespace gumshoe::tracing {

/// "Chosen rows" are those given to the constructor. Keeps a reference to the design.
class PureError {
public:
  /// @param model  its variance component, if it has one, counts among what is projected out
  PureError(const Design& design, const std::vector<Index>& rows, const Replicates& replicates,
            const CovarianceModel& model = {});

  /// False if too few readings repeat: no other function may be called.
  bool known() const { return pure_.freedom >= least_freedom(); }
  double freedom() const { return pure_.freedom; }
  std::size_t cells() const { return cells_; }
  /// Standard deviation of the pure error of each column (chosen rows, SI), in units of the design's noise.
  Vector scale(const Matrix& residuals) const;
  /// n ln of the sum of squares without over that with the cells' constants, by column of residuals.
  Vector lack_of_fit(const Matrix& residuals) const;
  /// Root mean square of what repeats in one residual, in units of the design's noise; less what the pure error gives.
  double repeats(const Vector& residual) const;
  /// Whitened residuals about the model and the constants of cells (if known) and blocks.
  Matrix about_cells(const Matrix& residuals) const { return with_(whitened(residuals)); }
  /// Factors without which what repeats is no longer described.
  std::vector<std::string> depends_on(const Vector& residual) const;

private:
  /// What is projected out: for each cell orthonormal columns over its own rows, then others.
  struct Projection {
    std::vector<std::pair<std::vector<Index>, Matrix>> by_cell;
    Matrix basis;
    double freedom = 0;
    Matrix off_cells(Matrix x) const;
    Matrix operator()(const Matrix& x) const;
    Vector squares(const Matrix& x) const { return (*this)(x).colwise().squaredNorm().transpose(); }
  };
  static double least_freedom();
  Matrix whitened(const Matrix& residuals) const;
  struct Cleaned {
    Matrix data;    ///< whitened; outlying readings replaced by what the others of their cell and pass say
    Vector freedom; ///< by column
  };
  Cleaned cleaned(const Matrix& residuals) const;
  /// @param cell  by place in the sequence; empty: no cells
  Projection projection(const std::vector<std::size_t>& cell, bool lines, const Matrix& others) const;

  const Design& design_;
  std::vector<Index> rows_;
  const Replicates& replicates_;
  std::size_t cells_ = 0;
  Matrix nuisance_;                  ///< whitened columns of the model and, where they are blocks, constants of passes
  Projection without_, with_, pure_; ///< without and with the cells' constants; with all that drifts, too
};

} // namespace gumshoe::tracing
