#pragma once
/// Parameters of a traced scenario, each a sum of sizes of the fit.
#include <utility>
#include <vector>

#include "calibration/estimate.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// Columns among the fit's fixed ones, and what each counts.
using MadeOf = std::vector<std::pair<Index, double>>;

/// A parameter as it is written.
struct Line {
  calibration::Unknown unknown;
  double value = 0; ///< SI
  MadeOf made_of;   ///< empty: held, exact
  Taken taken;
  double spread = 0; ///< a further standard uncertainty of its own, SI
};

/// Covariance of two sums, SI.
/// @param of_columns  covariance of the columns; it need not be symmetric to the last bit
double covariance_of(const Matrix& of_columns, const MadeOf& a, const MadeOf& b);

/// Value and columns of a line whose size is made of those of a term.
/// @param share  by size of the term
void of_shares(const JointFit& fit, std::size_t term, const Vector& share, Line& line);

/// The same of a group that the fit has no reading of: the mean of the groups that it has, with the spread of one more.
/// Returns how many it has.
/// @param shares  by effect, groups x sizes of the term; rows of NaN are not measured
std::size_t of_a_group_not_measured(const JointFit& fit, std::size_t term, const std::vector<Matrix>& shares,
                                    Line& line);

} // namespace gumshoe::tracing
