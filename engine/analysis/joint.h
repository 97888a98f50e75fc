#pragma once
/// Several measurands at once: JCGM 102:2011, clause 7.
#include <vector>

#include "analysis/results.h"
#include "analysis/samples.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Covariance and joint coverage regions of samples of several measurands, one column each, in SI, NaN where failed.
/// The ellipsoid's k_p is the p-quantile of the Mahalanobis distance (7.7.2), the rectangle's k_q that of the largest
/// |y_i - estimate_i| / u_i (7.7.3); their standard errors are those of an order statistic, for the covariance as it
/// stands. k_p is NaN, with a remark, if the correlation matrix is singular to within the samples' rounding. The values
/// are read in passes and not copied.
JointRegion joint_region(const std::vector<Column>& values, double coverage_probability, int threads = 1);

/// Joint regions of the scenario's groups (AnalysisOptions::joint), at each reading. A group with a measurand without
/// standard uncertainty has no region, and a remark says so.
std::vector<JointRegion> joint_regions(const propagation::Experiment& experiment, const Samples& samples,
                                       const std::vector<Summary>& summaries, const std::vector<Budget>& budgets,
                                       int threads);

} // namespace gumshoe::analysis
