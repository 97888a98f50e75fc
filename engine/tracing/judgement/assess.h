#pragma once
/// How unusual is the largest of all statistics, were nothing there? By parametric bootstrap.
#include <cstdint>
#include <functional>

#include "tracing/fit/scan.h"

namespace gumshoe::tracing {

/// Null distribution of one statistic, matched to the draws: a gamma distribution of their mean and variance.
struct Null {
  double mean = 1, variance = 2;
  double p(double statistic) const; ///< of one as large
  double quantile(double p) const;  ///< statistic that is exceeded with this probability
};

struct Assessment {
  Statistics data;                 ///< of the one data set
  std::vector<Null> null;          ///< by signature
  std::vector<double> p;           ///< by signature, were it the only one
  double p_anything = 1;           ///< of signatures, components and the noise's size together
  double p_signature = 1;          ///< of the largest signature, beside the noise as fitted, components included
  std::vector<double> p_component; ///< by variance component, over all that was tried
  double p_noise = 1;              ///< of residuals as large as these, were the declared noise true; alone
  double p_noise_overall = 1;      ///< the same over all that was tried
  bool noise_small = false;        ///< smaller than declared, 1 in 1000
  double threshold = 0;            ///< p below which a single signature counts
  Departures departures;           ///< of the draws from normal ones
};

/// What draws of a variance component do to the readings, tabled as in Departures, the noise's variance given; empty:
/// what the structure says.
using ScatterResponse = std::function<Matrix(const Structure&, double variance)>;

/// @param declared  true standard deviation over the design's, were the declared noise true; 0: none is declared
Assessment assess(const Scan& scan, const Vector& residuals, int draws, std::uint64_t seed, double alpha,
                  double declared, const ScatterResponse& response = {});

} // namespace gumshoe::tracing
