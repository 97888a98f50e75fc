#pragma once
/// Significance of the largest of all statistics under the null hypothesis, by parametric bootstrap.
#include <cstdint>
#include <functional>

#include "tracing/fit/scan.h"
#include "tracing/noise/coarse_steps.h"
#include "tracing/noise/pure_error.h"

namespace gumshoe::tracing {

/// Null distribution of one statistic, matched to the draws: a gamma distribution of their mean and variance.
struct Null {
  double mean = 1, variance = 2;
  /// A candidate that is so many times rarer than others: its p-values count so many times (weighted p-values, Genovese
  /// et al. 2006, Biometrika). All together keep the false-alarm rate.
  double rarity = 1;
  double single(double statistic) const; ///< p-value of a statistic as large
  double p(double statistic) const;      ///< the same, times the rarity
  double quantile(double p) const;       ///< statistic that is exceeded with this probability, over the rarity
};

struct Assessment {
  Statistics data;                 ///< statistics of the measured data
  std::vector<Null> null;          ///< by signature
  std::vector<double> p;           ///< p-value by signature, if it were the only one tried
  double p_anything = 1;           ///< p-value of signatures, components, lack of fit and the noise's size together
  double p_signature = 1;          ///< p-value of the largest signature, given the noise as fitted
  std::vector<double> p_component; ///< p-value by variance component, over all candidates tried
  double p_noise = 1;              ///< p-value of the size of the residuals under the declared noise
  double p_noise_overall = 1;      ///< the same over all candidates tried
  double p_lack_of_fit = 1;        ///< p-value of what repeats, over all candidates tried; 1: nothing repeats
  std::vector<double> p_block;     ///< p-value by block of its scatter, over all candidates tried; empty: no blocks
  bool noise_small = false;        ///< true if the noise is smaller than declared, at a level of 1 in 1000
  double threshold = 0;            ///< p-value below which a single signature counts
  NoiseShape noise_shape;          ///< shape of the draws
};

/// Response of the readings to draws of a variance component, tabulated as NoiseShape::scatter, given the variance of
/// the noise; empty: as in the covariance model.
using ScatterResponse = std::function<Matrix(const CovarianceModel&, double variance)>;

/// Readings of equal conditions and of blocks: what repeats, and which block scatters.
struct Repeats {
  PureError pure;                 ///< not known: lack of fit is not tested
  std::vector<std::size_t> block; ///< by row of the scan; empty: no blocks
  std::size_t blocks = 0;
  double step = 0; ///< in which readings were recorded, in units of the design's noise; 0: not known
  CoarseSteps steps = {}; ///< in which draws are read as well
};

/// Assesses one data set (residuals of the scan's rows, SI) against 2 x `draws` sets of the fitted noise.
/// @param alpha     probability of any finding if there is nothing to find
/// @param declared  ratio of the true standard deviation to the design's under the declared noise; 0: none is declared
/// @param repeats   what comes back, of the same rows; null: it is not tested
/// @param freedom   degrees of freedom of the declared noise
/// @param rarity    by signature, Null::rarity; empty: 1
/// @param exact     by signature, a ratio by the exact model that takes the place of a smaller one; empty: none
Assessment assess(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                  double declared, const ScatterResponse& response = {}, const Repeats* repeats = nullptr,
                  double freedom = std::numeric_limits<double>::infinity(), const std::vector<double>& rarity = {},
                  const std::vector<double>& exact = {});
/// The same with more draws as long as a p-value that decides is near alpha (criteria.h).
Assessment assess_surely(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                         double declared, const ScatterResponse& response, const Repeats* repeats, double freedom,
                         const std::vector<double>& rarity, const std::vector<double>& exact);

} // namespace gumshoe::tracing
