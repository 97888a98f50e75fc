#pragma once
/// Errors of readings that a fit has not seen.
#include "tracing/noise/design.h"

namespace gumshoe::tracing {

/// Of one held-out block, for one residual or many (columns).
struct HeldOut {
  Matrix residual;  ///< test rows x sets, SI; the block's own constants are taken off
  Vector squares;   ///< [set], in units of the noise of single readings
  Vector whitened;  ///< [set], in units of all that is declared of them together; expected: count
  double count = 0; ///< rows minus the block's own constants; 0: not scored
  std::vector<Index> rows;
};

/// Predicts `test` rows from a fit of `train` rows under a structure of noise: fixed and `extra` columns as the
/// training rows tell them; declared quantities stay at what is declared, so their uncertainty is part of the error.
/// Fixed columns that no training row feels are the block's own constants; they are projected out of its residuals, and
/// where there are as many as rows it is not scored.
/// @param residual all rows x sets, at the point where the design was linearised
HeldOut hold_out(const Design& design, const Matrix& residual, const Matrix& extra, const std::vector<Index>& train,
                 const std::vector<Index>& test, const Structure& structure);

/// Rows of all readings for which `chosen` holds.
std::vector<Index> rows_where(const Observations& observations, const std::vector<bool>& chosen);

/// Parts of the training readings to be left out in turn: by block if there are three or more, else five stretches of
/// the sequence.
std::vector<std::vector<Index>> folds(const Observations& observations, const std::vector<Index>& rows);

} // namespace gumshoe::tracing
