#pragma once
/// Readouts that stand in a data file: readings = { column, unit }, or the column's name alone. The file, its labels,
/// conditions and selection are those of [data], or stand next to the column.
#include "scenario/readouts.h"

namespace gumshoe::scenario {

std::vector<Key> readouts_file_keys();
/// [data]
std::vector<Key> data_keys();
/// Checks what no indication or all of them ask for: unknown keys, the file, the units.
void check_data(Table& top, Context& context);
/// Refuses a [data] of which no indication reads a column. For scenarios whose indications are sound.
void refuse_unread_data(Table& top, Context& context);
/// Reads `readings` of the indication. `conditions`: SI, by position in the model's card; columns of the file replace
/// them.
IndicationReadouts read_readouts_file(Table& indication, const VariableCard& card, const ModelCard& model,
                                      const std::vector<double>& conditions, Context& context);

/// Labels as a table of texts: { rod = "rod 1" }.
quantities::Labels read_own_labels(Table table);
/// True, and a problem, if a label has the name that as a scope means every reading.
bool reserved(const Member& label, const std::string& path, Problems& problems);
/// Position in the model's card; the number of conditions if there is none of that name.
std::size_t condition_index(const ModelCard& model, const std::string& name);

} // namespace gumshoe::scenario
