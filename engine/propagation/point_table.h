#pragma once
/// The forward model at given points, without sampling: the work of `gumshoe evaluate`.
#include <string>
#include <vector>

#include "base/csv.h"
#include "propagation/experiment.h"

namespace gumshoe::propagation {

struct PointTable {
  std::vector<std::string> header;          ///< headers of the added columns: "bottom_height (mm)"
  std::vector<std::vector<double>> columns; ///< in those units; NaN where the status is not ok
  std::vector<std::string> status;          ///< "ok" or why there is no value
  std::vector<std::string> notes;           ///< remarks of a joint evaluation on what its readings leave undetermined
  bool joint = false;                       ///< the table's rows were evaluated together: one row of results
  /// Cells outside the model's limits and points without a finite value, at their lines; their rows have no value.
  std::vector<Problem> impossible;
};

/// Header cells are `name (unit)`: quantities, conditions, effects' quantities (effect.quantity) and
/// indications, in any order; those left out keep their defaults. Without indications the added
/// columns are the solved measurands and the simulated indications; with them, the measurands
/// evaluated from them, row by row or, by a joint evaluation, from all rows together. Throws InputError for headers and
/// cells that cannot be read.
/// @param evaluation empty: the scenario's, or the first
/// @param values     a scenario of the model, whose estimates and conditions take the place of the defaults; null: none
/// @param decimal    decimal sign of the table's numbers, '.' or ','
PointTable evaluate_points(const models::Model& model, const Csv& table, const std::string& evaluation,
                           const Experiment* values = nullptr, char decimal = '.');

} // namespace gumshoe::propagation
