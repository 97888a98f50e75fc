#pragma once
/// Reads what was read: inline, from a data file, or as rows; rows with equal labels and conditions
/// are repeats of one reading.
#include "base/card.h"
#include "scenario/conditions.h"
#include "scenario/data_file.h"

namespace gumshoe::scenario {

/// Readouts under the same labels and conditions.
struct Readouts {
  quantities::Labels labels;
  std::vector<double> conditions; ///< SI, by position in the model's card
  std::vector<double> values;     ///< SI; empty in a virtual experiment
  int repeats = 1;
  std::vector<std::size_t> rows = {}; ///< of the data file, by readout; empty without one
  std::size_t reading = 0;            ///< position among the readings of the scenario
};

struct IndicationReadouts {
  std::vector<Readouts> used;
  std::vector<Readouts> all; ///< also the rows that `where` leaves out by their labels: what can be pooled
  std::optional<DataFile> file; ///< that they stand in
  std::string column;           ///< of it
  quantities::Labels fixed;     ///< labels of which `where` leaves one value
};

/// Keys of an indication that say what was read.
std::vector<Key> readout_keys();

/// Reads the keys readings, rows and labels of [indications.NAME]. Conditions listed one a reading need as many
/// readings, or none.
IndicationReadouts read_readouts(Table& table, const VariableCard& card, const ModelCard& model,
                                 const Conditions& commanded, Context& context);

} // namespace gumshoe::scenario
