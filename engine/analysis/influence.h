#pragma once
/// Confidence intervals from influence values (the delta method), summed over groups of independent rows.
#include <string>
#include <vector>

namespace gumshoe::analysis {

inline constexpr double index_confidence = 0.95;

struct Estimate {
  double value = 0, low = 0, high = 0;
  std::string verdict; ///< index_verdict.h
};

/// value +- t SE, with SE^2 = G / (G - 1) times the sum of squares of the groups' influence sums, and t the quantile
/// of Student's distribution with G - 1 degrees of freedom; with fewer, 2 (G - 1) / (kurtosis - 1), where a few groups
/// hold most of the squares, as of heavy-tailed output. G counts the groups that have valid rows. Below two
/// groups, or without a value, the interval is NaN.
Estimate with_interval(double value, const std::vector<double>& influence, const double* rows_of_group);

} // namespace gumshoe::analysis
