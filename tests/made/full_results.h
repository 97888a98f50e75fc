#pragma once
/// A made-up result in which every study has something to say: what files and reports are tested with.
#include "analysis/results.h"

namespace gumshoe::made {

inline constexpr std::uint64_t samples = 640;

/// Four measurands of one reading: a height whose budget misses a non-linear quantity, a run-out with correlated inputs
/// and its angle, a loss without a standard uncertainty.
std::vector<propagation::Output> outputs();
/// Sample i of output k, SI: quantiles of a normal distribution in a shuffled order.
double value(std::size_t output, std::uint64_t i);
analysis::Results full_results();
/// Writes it all to `path`.
void write_full_result(const std::string& path);

} // namespace gumshoe::made
