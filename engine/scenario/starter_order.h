#pragma once
/// The order of the rows of a log: a time that starts anew in each block is none, and the blocks may be numbered.
#include <string>
#include <vector>

#include "scenario/recognise.h"

namespace gumshoe::scenario {

/// Whether a column names blocks that are measured one after the other: cycles, runs, days.
bool counts_blocks(const RecognisedColumn& column);

/// Columns of blocks at whose changes the time goes back, while it rises within each of them: "day, run". Empty: the
/// time is the order of the readings, or nothing says when it starts anew.
std::vector<const RecognisedColumn*> restarted_by(const RecognisedData& data, const RecognisedColumn& time);

/// Columns of blocks with four numbers or more that never fall from one row to the next.
std::vector<const RecognisedColumn*> numbered_blocks(const RecognisedData& data);

/// Columns of days that recur, three or more, none of which is before the one in the row above.
std::vector<const RecognisedColumn*> days_in_order(const RecognisedData& data);

/// The columns by which the rows are sorted, where no time tells their order: a position or a temperature, up or down,
/// in a table of a calibration whose rows are not numbered; or two labels and more that are crossed, the slowest first,
/// where readings of equal labels stand together: a table of a study. Empty: there are none.
/// @param labels columns of words that tell readings apart
std::vector<const RecognisedColumn*> sorted_by(const RecognisedData& data,
                                               const std::vector<const RecognisedColumn*>& labels);

} // namespace gumshoe::scenario
