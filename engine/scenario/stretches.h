#pragma once
/// Blocks that are stretches of the data: [trace] blocks = { every = "30 min", of = "time" } or { count = 6 }.
#include "scenario/number_column.h"

namespace gumshoe::scenario {

/// The label that says in which stretch a reading was taken: "1", "2", ...
inline constexpr const char* stretch_label = "block";

/// Shape of such a table.
Shape stretches_shape();
/// Whether [trace] asks for stretches.
bool has_stretches(const Node* trace);

/// What stretches go by: a condition or a column of [trace].
struct StretchAxis {
  std::vector<double> values; ///< by row, SI
  std::string si_unit;
};

/// The data whose rows are divided.
struct StretchedData {
  const DataFile& file;
  const std::vector<std::size_t>& rows;                 ///< those used
  const std::map<std::string, StretchAxis>& conditions; ///< that are columns, at these rows
};

/// The stretch of each row. Without `of` the order of [trace], or that of the rows, counts; `every` needs one of the
/// former. Empty, and problems, if something is wrong.
std::vector<std::string> stretches(const Node& trace, const StretchedData& data, Problems& problems);

} // namespace gumshoe::scenario
