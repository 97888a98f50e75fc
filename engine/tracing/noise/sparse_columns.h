#pragma once
/// Columns that move few rows each, by row: in units of the noise of readings.
#include <vector>

#include "tracing/noise/design.h"
#include "tracing/noise/elimination.h"

namespace gumshoe::tracing {

/// "Chosen rows" are those given to the constructor: whole readings, in order. Keeps a reference to the design.
class SparseColumns {
public:
  SparseColumns(const Design& design, std::vector<Index> chosen)
      : design_(design), chosen_(std::move(chosen)), rows_(chosen_.size()) {}

  /// Columns over all rows of the design.
  void add(const Eigen::Ref<const Matrix>& columns);
  /// For each group and indication a constant. @param group  by place in the sequence
  void add_constants(const std::vector<std::size_t>& group) { add_by_group(group, false, 0); }
  /// For each group of so many readings or more, and each indication, a straight line in the order of measurement.
  void add_lines(const std::vector<std::size_t>& group, std::size_t least) { add_by_group(group, true, least); }

  std::size_t count() const { return count_; }
  const std::vector<SparseRow>& rows() const { return rows_; }

private:
  void add_by_group(const std::vector<std::size_t>& group, bool line, std::size_t least);
  /// Values of column `count_` in the rows of one reading, in SI.
  void add_reading(Index first_row, Vector values);

  const Design& design_;
  std::vector<Index> chosen_;
  std::vector<SparseRow> rows_;
  std::size_t count_ = 0;
};

/// Columns without which the others span the same, ascending. Their units do not matter.
/// @param least  share of a column's length that the others must leave of it
std::vector<std::size_t> redundant(const std::vector<SparseRow>& rows, std::size_t columns, double least);

/// Columns that those of lower number explain but for rounding, ascending.
std::vector<std::size_t> explained_by_earlier(const std::vector<SparseRow>& rows, std::size_t columns);

} // namespace gumshoe::tracing
