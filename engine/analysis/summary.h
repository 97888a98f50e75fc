#pragma once
/// Statistics of Monte Carlo values: JCGM 101 clauses 7.6 and 7.7.
#include <optional>
#include <vector>

#include "analysis/column.h"
#include "analysis/ordered_column.h"
#include "analysis/results.h"

namespace gumshoe::analysis {

/// Central moments by pairwise sums over fixed leaves of 1,024 values in order, so the bits depend on
/// neither threads nor block size. NaN is left out.
struct Moments {
  double mean = 0, variance = 0; ///< variance with divisor n - 1
  double skewness = 0, kurtosis = 0;
  std::size_t valid = 0; ///< values that are not NaN
};
/// NaN without values; the variance also of a single one. Skewness and kurtosis are 0 without variance.
/// @param threads 0: all processors
Moments moments(const Column& values, int threads = 1);

/// Fewer values have the same skewness, 0 of any two, or the same kurtosis, 1 of any two and 1.5 of any three: a summary
/// states none.
inline constexpr std::size_t least_for_skewness = 3, least_for_kurtosis = 4;

/// JCGM 101 7.7.2: q = pM rounded to an integer; an interval runs from rank r to rank r + q of the M ordered values.
std::size_t covered_ranks(std::size_t values, double coverage_probability);

/// Ends of the probabilistically symmetric coverage interval (7.7.2). Reorders the values; none may be NaN.
struct Ends {
  double low, high;
};
Ends symmetric_ends(std::vector<double>& values, double coverage_probability);

/// Half-width of the interval about y that holds as many of the values as a coverage interval. None may be NaN.
double half_width_about(double y, std::vector<double> values, double coverage_probability);

/// What bounds the memory of a summary. The figures do not depend on it.
struct Limits {
  std::size_t sorted = std::size_t{1} << 20; ///< of so many values the tails are copied and sorted
  OrderedColumn::Limits ordered;             ///< of more
};
/// The order of a column that was too long to sort its tails, for those who ask for more of it.
using KeptOrder = std::optional<OrderedColumn>;

/// Estimate, u, both coverage intervals and their Monte Carlo standard errors. NaN counts as failed;
/// the rank bounds hold whatever values the failed samples had. `values` is in sample order, SI.
/// Passes over the values in parallel (threads 0: all), three or four of them. Only the tails of few values are copied
/// and sorted; order statistics of many are found in bounded memory, most of them by the way.
/// @param order  keeps what was found, with the ranks that check_tails() will ask for; refers to `values`
Summary summarise(const propagation::Output& output, const Column& values, double coverage_probability, int threads = 1,
                  KeptOrder* order = nullptr, Limits limits = Limits());
/// Values that differ by the rounding of their own computation alone, as where a common error cancels, are one value.
/// For outputs of which no budget says that they are uncertain.
/// @param largest  largest contribution of the output's budget, SI: contributions that cancel leave their rounding
void join_rounded(Summary& summary, double largest = 0);

} // namespace gumshoe::analysis
