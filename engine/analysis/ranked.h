#pragma once
/// Order statistics of values that are computed when they are wanted, and not kept.
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/column.h"

namespace gumshoe::analysis {

/// Computes values [first, first + out.size()) of a sequence. Called on several threads at the same time.
using Fill = Column::Fill;

/// The values of the given ranks (from 0, rising) among `n` values: exactly those that sorting would give.
///
/// A sample of the values brackets the ranks; one pass counts what lies below the bracket and keeps what lies inside, a
/// few per cent or less. Many values, and those of which the bracket misses a rank, are ordered in bounded memory
/// (ordered_column.h). Linear in n, on `threads` threads.
std::vector<double> ranked(std::size_t n, const Fill& fill, std::span<const std::size_t> ranks, int threads);

} // namespace gumshoe::analysis
