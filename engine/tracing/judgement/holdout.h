#pragma once
/// Prediction errors of readings that were not fitted.
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

/// Errors of one held-out block, for one residual or many (columns).
struct HeldOut {
  Matrix residual;  ///< test rows x sets, SI; the block's offsets are subtracted
  Vector whitened;  ///< sum of squares by set, in units of the whole declared covariance; expectation: count
  Vector declared;  ///< the first set, draws as declared, in units of the noise of readings
  Vector weighted;  ///< the same by the inverse of that covariance: the product of both is its `whitened`
  double count = 0; ///< rows minus the block's offsets; 0: not scored
  std::vector<Index> rows;
};

/// Predicts `test` rows from a fit of `train` rows under a covariance model. Fixed columns, those of terms included,
/// and declared draws are fitted to the training rows. `whitened` holds the draws as declared, with their uncertainty:
/// a declared value that the training rows contradict counts against the fit.
/// Fixed columns to which no training row is sensitive are the block's offsets: they are projected out of its
/// residuals, and a block with no more rows than offsets is not scored.
/// @param residual  all rows x sets, SI, at the point where the design was linearised
/// @param units     covariance model in whose units `whitened` is: one and the same for fits that are compared
HeldOut hold_out(const Design& design, const Matrix& residual, const std::vector<Index>& train,
                 const std::vector<Index>& test, const CovarianceModel& model, const CovarianceModel& units);

/// Minus twice the logarithm of the density of `test` rows given `train` rows (one residual, all rows, SI), constants
/// left out. Unlike `whitened`, it holds what the training rows say of columns and draws, and how well: where declared
/// values are wide, they could otherwise be anything that the test rows ask for. Offsets of the block are projected
/// out.
double minus_log_density(const Design& design, const Matrix& residual, const std::vector<Index>& train,
                         const std::vector<Index>& test, const CovarianceModel& model);

/// The same residuals (one set or more) with those of `rows` winsorised, as every fit of these rows sees them: what is
/// predicted from them, or left of them, is that fit's.
Matrix winsorised_in(const Design& design, const std::vector<Index>& rows, Matrix residual);

/// Rows of all readings for which `chosen` holds.
std::vector<Index> rows_where(const Observations& observations, const std::vector<bool>& chosen);

/// Parts of the training rows to be left out in turn: by block if there are enough, else stretches of the sequence.
std::vector<std::vector<Index>> folds(const Observations& observations, const std::vector<Index>& rows);

/// How each fold is judged.
enum class Judged { as_declared /** HeldOut::whitened */, given_the_others /** minus_log_density */ };
/// Cross-validation: sum over the folds, each predicted from the others, under the given covariance model. Compare fits
/// under one covariance model.
double cross_validated(const Observations& observations, const std::vector<Index>& rows, const JointFit& fit,
                       const CovarianceModel& model, Judged judged);

} // namespace gumshoe::tracing
