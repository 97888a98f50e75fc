#pragma once
/// Heavy tails: when a standard uncertainty would say nothing.
#include <vector>

#include "analysis/column.h"
#include "analysis/results.h"
#include "analysis/summary.h"
#include "propagation/experiment.h"

namespace gumshoe::analysis {

/// Sets `hill_index`: the smaller of both tails' index by Hill's estimator (Hill 1975), of the deviations from the
/// median, over the k = n^0.6 largest; its standard error is index / sqrt(k). NaN below 1,000 valid samples, or where a
/// tail does not leave the median.
///
/// Takes the standard uncertainty back and says so in `warning` if all hold: the index lies below 2.25 by 2.5 standard
/// errors; over the k / 10 largest alone it is not above 2.25 by 2 (outliers in a cluster are no power law); and the
/// variance has not settled, its relative standard error sqrt(kurtosis / n) being above 3 %. An index below 4 and one
/// above 10 %: `tail_remark`. A mixture with a much wider law in less than a per cent of the samples may look alike. It
/// is also taken back where double precision holds the values, but not their moments.
/// Where the index cannot be told from one of 1 or less, by 2 standard errors in the tail and far out, the expectation
/// does not exist either: use_median(). Call after summarise(); `values` is in sample order, NaN where failed. Linear
/// in their number.
/// @param order  what summarise() left of the values, if it did
void check_tails(const Column& values, Summary& summary, int threads = 1, const KeptOrder* order = nullptr);

/// The variate with the fewest degrees of freedom that moves an output, or what it has less another one, if it is a t
/// without a variance; null: none is.
/// @param less  budget of the output that is subtracted; null: none
const quantities::Variate* without_variance(const propagation::Experiment& experiment, const Budget& budget,
                                            const Budget* less = nullptr);

/// Withholds the moments that do not exist, for a reason in the inputs (`without`) or in the tails of the values.
void withhold(Summary& summary, const quantities::Variate* without, const Column& values, int threads,
              const KeptOrder& order);

/// Adds the ranks that check_tails() asks for, of so many values that are not NaN.
void add_tail_ranks(std::size_t valid, std::vector<RankRange>& ranks);

/// Replaces the estimate by the median of the valid values, with its standard error, and says so in `warning`, which
/// holds the reason already.
void use_median(const Column& values, Summary& summary, int threads = 1);

} // namespace gumshoe::analysis
