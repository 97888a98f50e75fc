#pragma once
/// The columns of a table of points, matched to the inputs of a model.
#include <string>
#include <vector>

#include "base/csv.h"
#include "models/model.h"
#include "propagation/experiment.h"

namespace gumshoe::propagation {

/// One value of the model that a table column may set.
struct Slot {
  std::string name, unit, si_unit;
  double value = 0; ///< SI, used if no column gives it
  Limits limits{};
  const EffectCard* effect = nullptr; ///< effect that owns the quantity
  bool freed = false;                 ///< by a scenario: its effect acts whether or not the table names it
  bool one = true;                    ///< false: it has several values in a scenario, of which the table must give one
  std::vector<double> column{};       ///< given values, SI; empty: the default
  int given_column = -1;
  const double& at(std::size_t row) const { return column.empty() ? value : column[row]; }
};

struct TableColumns {
  /// Slots in the order of Layout, then the conditions. Of the effects, only those that the table names or the
  /// scenario frees are included.
  std::vector<Slot> slots;
  std::vector<const EffectCard*> acting;
  std::vector<Problem> problems;   ///< headers and cells that cannot be read
  std::vector<Problem> impossible; ///< cells outside the model's limits
  std::vector<bool> bad_row;       ///< rows with such a cell

  /// Slot with this name if the table has a column for it; otherwise null.
  const Slot* given(std::string_view name) const;
};

/// @param values  those of a scenario take the place of the card's defaults; null: none
/// @param decimal decimal sign of the table's numbers, '.' or ','
TableColumns table_columns(const models::Model& model, const Csv& table, const Experiment* values = nullptr,
                           char decimal = '.');

} // namespace gumshoe::propagation
