#pragma once
/// Readings side by side, as sheets of ISO 230-2 have them.
#include <string>

#include "base/csv.h"

namespace gumshoe::scenario {

/// Readings that share a row, as a table with one row for each, in the order in which they were taken as far as the
/// table shows it; empty where none do. Columns may be
///   runs         "R1+", "R1-", "R2+", "Run 3 up"; numbers are runs where they count from 1
///   both         "up_1", "down_1", "fwd2": a direction, then the number of the run
///   directions   "Forward (um)", "Backward (um)", of each cycle's rows the way back from the last to the first
///   targets      "0 mm", "50 mm", "100 mm": each row is a run
std::string below_each_other(const Csv& csv);

} // namespace gumshoe::scenario
