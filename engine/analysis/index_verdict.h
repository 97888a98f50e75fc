#pragma once
/// How well an index is known, in a word, from its confidence interval.
#include <string_view>

namespace gumshoe::analysis {

/// Intervals wider than this say too little of an index that lies between 0 and 1.
inline constexpr double widest_interval = 0.1;

/// "not converged": the interval is wider than 0.1, or there is none; take more rows.
/// "zero within its interval": the interval reaches 0, or misses it by rounding; at this number of rows the index
/// cannot
///   be distinguished from zero. A total index is a mean of squares and falls under this only if (nearly) no row's
///   output moved with the input; an input with a small effect has a small total index that is resolved.
/// "resolved": the interval lies above 0 (or, by chance in one index of forty, below it).
constexpr std::string_view verdict(double low, double high) {
  if (!(high - low <= widest_interval)) return "not converged";
  constexpr double rounding = 1e-12;
  return low <= rounding && high >= -rounding ? "zero within its interval" : "resolved";
}

} // namespace gumshoe::analysis
