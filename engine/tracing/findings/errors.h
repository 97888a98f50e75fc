#pragma once
/// Errors of a fit in SI units: of the readings that it was fitted to, and of blocks that it predicts.
#include <string>
#include <vector>

#include "tracing/fit/joint_fit.h"
#include "tracing/judgement/decisions.h"

namespace gumshoe::tracing {

/// Blocks that are predicted from other readings, each by itself.
struct Blocks {
  std::vector<std::vector<Index>> rows;
  std::vector<std::string> names;
};
/// The hold-out blocks; where there are too few to hold some out, every block in turn.
Blocks predicted_blocks(const Observations& observations);

/// What a residual of each indication counts as in the unit of the first one's: itself; where they are of different
/// kinds, by their typical noise.
Vector in_first(const Observations& observations, const Design& design);

/// Errors of blocks that were predicted.
struct Scores {
  std::vector<double> rms; ///< of the residuals, by set of them; NaN where nothing was scored
  double whitened = 0;     ///< sum of squares of the first set in units of all that is declared
  double worst_block = none;
  std::string worst_name;
  Vector residual; ///< of the first set, all rows; NaN where not scored
  Vector declared, weighted; ///< HeldOut::declared, weighted; all rows, NaN where not scored
  Vector in_first; ///< by indication: what its residual counts as, in the unit of the first one's

  bool scored() const;
  Index worst_row() const; ///< row of the residual that counts most; -1: none was scored
  double worst_point() const;
  double counts(Index row) const; ///< its residual without sign, in the unit of the first indication's
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
};

/// Predicts blocks by the training rows (those outside the block).
/// @param residual  measured minus simulated at the fit's point, all rows x sets
/// @param units     covariance model of `whitened`
/// @param in_first  what residuals count as, by indication
Scores score(const JointFit& fit, const Matrix& residual, const std::vector<Index>& training, const Blocks& blocks,
             const CovarianceModel& units, const Vector& in_first);

/// What bad readings of the blocks exceed the bound by (criteria.winsor_limit robust standard deviations) in both of
/// two predictions, the lesser of the two; all rows, zero elsewhere.
Vector excess(const Scores& before, const Scores& after, const Design& design);

/// Overstated, as hold-out blocks have it, of one prediction over another.
Overstated overstated(const Scores& before, const Scores& after, const Design& design);

/// The fit's own readings about the unknowns and declared draws, by least squares without correlation or component: of
/// equal noise, more terms never leave more.
struct InSample {
  Matrix left; ///< residuals, training rows x sets
  Vector rms;  ///< of these, by set; per degree of freedom
};
InSample in_sample(const JointFit& fit, const std::vector<Index>& rows, const Matrix& residual, const Vector& in_first);

} // namespace gumshoe::tracing
