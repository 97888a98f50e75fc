#pragma once
/// The columns of a table of points, matched to what a model takes.
#include <string>
#include <vector>

#include "base/csv.h"
#include "models/model.h"

namespace gumshoe::propagation {

/// One value of the model that a table column may set.
struct Slot {
  std::string name, unit, si_unit;
  double value = 0; ///< SI: where no column gives it
  Limits limits{};
  const EffectCard* effect = nullptr; ///< whose quantity it is
  std::vector<double> column{};       ///< given values, SI; empty: the default
  int given_column = -1;
  const double& at(std::size_t row) const { return column.empty() ? value : column[row]; }
};

struct TableColumns {
  /// In the order of Layout, then the conditions. Only effects that the table names are among them.
  std::vector<Slot> slots;
  std::vector<const EffectCard*> acting;
  std::vector<Problem> problems;   ///< headers and cells that cannot be read
  std::vector<Problem> impossible; ///< cells outside the model's limits
  std::vector<bool> bad_row;       ///< rows with such a cell

  /// The slot of this name, if the table has a column for it; else null.
  const Slot* given(std::string_view name) const;
};

TableColumns table_columns(const models::Model& model, const Csv& table);

} // namespace gumshoe::propagation
