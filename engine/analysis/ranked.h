#pragma once
/// Order statistics of values that are computed when they are wanted, and not kept.
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace gumshoe::analysis {

/// Computes values [first, first + out.size()) of a sequence. Called on several threads at the same time.
using Fill = std::function<void(std::size_t first, std::span<double> out)>;

/// The values of the given ranks (from 0, rising) among `n` values: exactly those that sorting would give.
///
/// A sample of the values brackets the ranks; one pass counts what lies below the bracket and keeps what lies inside, a
/// few per cent or less. Where the bracket misses a rank, all values are kept. Linear in n, on `threads` threads.
std::vector<double> ranked(std::size_t n, const Fill& fill, std::span<const std::size_t> ranks, int threads);

} // namespace gumshoe::analysis
