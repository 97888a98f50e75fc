#pragma once
/// The loading of a stated effect as a table, where no formula is known: its values at levels of conditions and
/// columns.
#include "scenario/stated_effects.h"

namespace gumshoe::scenario {

/// A table is linear between neighbouring levels of one condition or column, at equal levels of all others. A margin,
/// as a share of the range, continues it beyond the ends of what was measured, along the chord from the end to the
/// first level as far inside. Farther out it has one value, if one is stated. NaN elsewhere, because nothing is known
/// there.
class LoadingTable {
public:
  struct Limits {
    std::size_t place; ///< in the row of conditions followed by columns
    double low, high;  ///< between which there is a value, SI
  };

  /// @param inputs  places in the row of conditions followed by columns
  /// @param levels  [input][row], SI  @param loading by row, dimensionless
  /// @param margin  share of the range of an input   @param beyond  value farther out
  LoadingTable(std::vector<std::size_t> inputs, std::vector<std::vector<double>> levels, std::vector<double> loading,
               double margin, std::optional<double> beyond);
  /// @param known conditions followed by columns, SI
  double at(const std::vector<double>& known) const;
  /// The first input that lies beyond its limits; empty: each lies within, but no rows have all others at its level.
  std::optional<Limits> beyond(const std::vector<double>& known) const;
  const std::vector<std::size_t>& inputs() const { return inputs_; }

private:
  struct Row {
    std::vector<double> level; ///< by input
    double loading;
  };
  bool is_level(std::size_t input, double level, double x) const;
  /// Along one input, at the levels of all others.
  std::vector<std::pair<double, double>> line(std::size_t input, const std::vector<double>& known) const;
  double along(const std::vector<std::pair<double, double>>& line, std::size_t input, double x) const;
  double reach(std::size_t input) const { return margin_ * (high_[input] - low_[input]); }

  std::vector<std::size_t> inputs_;
  std::vector<Row> rows_;
  std::vector<double> low_, high_, rounding_; ///< by input
  double margin_;
  std::optional<double> beyond_;
};

Shape loading_table_shape();

/// Reads `table = { position = ["0 mm", "50 mm"], loading = [0, 1], margin = 0.05 }`; nullopt and problems if something
/// is wrong.
std::optional<LoadingTable> read_loading_table(Table& effect, const StatedScope& scope, Context& context);

} // namespace gumshoe::scenario
