#pragma once
/// Heavy tails: when a standard uncertainty would say nothing.
#include <span>

#include "analysis/results.h"

namespace gumshoe::analysis {

/// Sets hill_index; if the variance does not settle over the blocks of the run, or the tail index says that there is
/// none, takes the standard uncertainty back and says so in `warning`. `values` is in sample order.
void check_tails(std::span<const double> values, Summary& summary);

} // namespace gumshoe::analysis
