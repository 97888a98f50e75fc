#pragma once
/// Noise that is not the same for every group of a label: of operators, probes, machines.
#include <vector>

#include "tracing/noise/replicates.h"

namespace gumshoe::tracing {

struct NoiseByLabel {
  const Grouping* label = nullptr;
  std::vector<std::vector<double>> ratio; ///< by indication and group: standard deviation over the least of all
  /// Likewise: degrees of freedom. 0: the chosen rows do not tell, and all others stand for the group.
  std::vector<std::vector<double>> freedom;
  Matrix variance;    ///< reading of the scenario x indication: square of its ratio
  double gain = 0;    ///< 2 ln L over what criteria.noise_differs asks for
  bool plain = false; ///< it does so without any one pass, and they differ by criteria.unequal_spread
};

/// Labels whose groups' noise may differ: 2 ln L says so by half of what criteria.noise_differs asks for. Judged by
/// what is left about the model, the means of equal conditions and, for each group of every pass, a constant and a
/// straight line in time. The likelihood is that of Student's t with five degrees of freedom: a bad reading does not
/// decide. Blocks, and labels of one block each, have no noise of their own: nobody knows that of the next.
/// @param rows   chosen rows
/// @param about  their residuals about the model and the means of equal conditions, in units of the noise so far
std::vector<NoiseByLabel> noise_by_labels(const Observations& observations, const Replicates& replicates,
                                          const std::vector<Index>& rows, const Vector& about);

/// The same label with its ratios once more, and whether they are plain, from residuals in units of these ratios: where
/// equal conditions are those of several groups, their mean has the noise of all until it is weighted.
NoiseByLabel refined(const NoiseByLabel& so_far, const Observations& observations, const Replicates& replicates,
                     const std::vector<Index>& rows, const Vector& about);

} // namespace gumshoe::tracing
