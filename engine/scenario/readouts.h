#pragma once
/// Reads what was read: inline, from a data file, or as rows; rows with equal labels and conditions
/// are repeats of one reading.
#include "base/card.h"
#include "scenario/context.h"

namespace gumshoe::scenario {

/// Readouts under the same labels and conditions.
struct Readouts {
  quantities::Labels labels;
  std::vector<double> conditions; ///< SI, by position in the model's card
  std::vector<double> values;     ///< SI; empty in a virtual experiment
  int repeats = 1;
};

struct IndicationReadouts {
  std::vector<Readouts> used;
  std::vector<Readouts> all; ///< also the rows that `where` leaves out: what can be pooled
};

/// Reads the keys readings, rows and labels of [indications.NAME].
IndicationReadouts read_readouts(Table& table, const VariableCard& card, const ModelCard& model,
                                 const std::vector<double>& conditions, Context& context);

/// [conditions]: SI, by position in the model's card, defaults filled in.
std::vector<double> read_conditions(std::optional<Table> table, const ModelCard& model);

} // namespace gumshoe::scenario
