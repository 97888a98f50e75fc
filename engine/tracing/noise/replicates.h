#pragma once
/// Readings of equal conditions, taken again and again: the cells of an analysis of variance.
#include <string>
#include <vector>

#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

/// What tells one cell from another, by place in the sequence.
struct Factor {
  std::string name; ///< condition, column or label; "place in the block"
  std::vector<std::size_t> level;
};

/// By place in the sequence. Readings of one cell agree in every condition that was set, in every label that comes back
/// from block to block, and in their place among the equal readings of their block.
struct Replicates {
  std::vector<Factor> factors;
  std::vector<std::size_t> cell; ///< combination of the factors' levels
  std::vector<std::size_t> pass; ///< block, or without blocks a stretch of the sequence
  bool passes_are_blocks = false;
  /// Cells that the factors other than one distinguish; `without` = their number: all of them.
  std::vector<std::size_t> cells(std::size_t without) const;
  /// The same replicates, whatever the level of this factor.
  Replicates without(std::size_t factor) const;
};

Replicates find_replicates(const Observations& observations);

/// Columns of the chosen rows, whole readings of k indications: for each group and indication a constant or a straight
/// line in the order of measurement. @param group  by place in the sequence
Matrix columns_by_group(const std::vector<Index>& rows, std::size_t k, const std::vector<std::size_t>& group,
                        bool line);

} // namespace gumshoe::tracing
