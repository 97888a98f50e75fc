#pragma once
/// The loading of a stated effect as a table, where no formula is known: its values at levels of conditions and
/// columns.
#include "scenario/stated_effects.h"

namespace gumshoe::scenario {

/// A table of one condition or column is linear between neighbouring levels; one of several holds at their combinations
/// only. NaN elsewhere, because nothing is known there.
class LoadingTable {
public:
  /// @param inputs  places in the row of conditions followed by columns
  /// @param levels  [input][row], SI  @param loading by row, dimensionless
  LoadingTable(std::vector<std::size_t> inputs, std::vector<std::vector<double>> levels, std::vector<double> loading);
  /// @param known conditions followed by columns, SI
  double at(const std::vector<double>& known) const;
  const std::vector<std::size_t>& inputs() const { return inputs_; }

private:
  double between(double x) const;
  std::vector<std::size_t> inputs_;
  std::vector<std::vector<double>> levels_; ///< [row][input]; of one input ascending
  std::vector<double> loading_, range_;     ///< by row; by input
};

Shape loading_table_shape();

/// Reads `table = { position = ["0 mm", "50 mm"], loading = [0, 1] }`; nullopt and problems if something is wrong.
std::optional<LoadingTable> read_loading_table(Table& effect, const StatedScope& scope, Context& context);

} // namespace gumshoe::scenario
