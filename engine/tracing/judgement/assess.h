#pragma once
/// How unusual is the largest of all statistics, were nothing there? By parametric bootstrap.
#include <cstdint>
#include <functional>

#include "tracing/fit/scan.h"

namespace gumshoe::tracing {

/// Null distribution of one statistic, matched to the draws: a gamma distribution of their mean and variance.
struct Null {
  double mean = 1, variance = 2;
  double p(double statistic) const; ///< p-value of a statistic as large
  double quantile(double p) const;  ///< statistic that is exceeded with this probability
};

struct Assessment {
  Statistics data;                 ///< of the one data set
  std::vector<Null> null;          ///< by signature
  std::vector<double> p;           ///< p-value by signature, were it the only one tried
  double p_anything = 1;           ///< p-value of signatures, components and the noise's size together
  double p_signature = 1;          ///< p-value of the largest signature, given the noise as fitted
  std::vector<double> p_component; ///< p-value by variance component, over all that was tried
  double p_noise = 1;              ///< p-value of the residuals' size, were the declared noise true
  double p_noise_overall = 1;      ///< the same over all that was tried
  bool noise_small = false;        ///< smaller than declared, 1 in 1000
  double threshold = 0;            ///< p-value below which a single signature counts
  NoiseShape noise_shape;          ///< of the draws
};

/// What draws of a variance component do to the readings, tabulated as NoiseShape::scatter, given the variance of the
/// noise; empty: what the covariance model says.
using ScatterResponse = std::function<Matrix(const CovarianceModel&, double variance)>;

/// Assesses one data set (residuals of the scan's rows, SI) against 2 x `draws` sets of the fitted noise.
/// @param alpha     probability of any finding where there is nothing
/// @param declared  true standard deviation over the design's, were the declared noise true; 0: none is declared
Assessment assess(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                  double declared, const ScatterResponse& response = {});

} // namespace gumshoe::tracing
