#pragma once
/// Parts that first scenarios share: names, lines with comments, sections about a data file.
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/starter.h"
#include "scenario/starter_names.h"
#include "scenario/write.h"

namespace gumshoe::scenario {

/// Names in the scenario, and their columns.
using NamedColumns = std::vector<std::pair<std::string, const RecognisedColumn*>>;

/// "key = value", and a comment if it is not empty.
std::string line(const std::string& key, const std::string& value, const std::string& comment);
std::string unit_or(const RecognisedColumn& c, const char* otherwise);
/// Unit of differences of a column's numbers: K of degC.
std::string difference_unit_or(const RecognisedColumn& c, const char* otherwise);
/// `u` of a reading: a column of the data that was recognised as it, or a comment that shows how it is stated.
std::string noise_line(const RecognisedColumn& reading, const RecognisedColumn* uncertainty);

/// Whether a column has this name, but for its unit: "X_mm" is X.
bool is_named(const RecognisedColumn& c, std::string_view name);
/// Columns whose words tell readings apart: cycles, texts that recur, and few numbers without a unit. Rows with an
/// empty cell in one are left out; with many of them it is none. One that is another under a second name is none.
/// @param used names of columns that are read as numbers
NamedColumns labels_of(const RecognisedData& data, const std::set<std::string>& used = {});
/// The label with enough values for blocks; null: there is none.
const NamedColumns::value_type* block_label(const RecognisedData& data, const NamedColumns& labels);
/// Whether a label is empty in a row that has a reading.
bool has_empty_cells(const RecognisedData& data, const RecognisedColumn& label);
/// The column of the readings' standard uncertainties, all of them above 0; null: there is none.
const RecognisedColumn* uncertainty_of(const RecognisedData& data);
/// Why a scenario does not use a column, or what its role rests on; empty: nothing to say.
std::string why_not_used(const RecognisedData& data, const RecognisedColumn& column);

/// Whether the words of a column alternate: each part was measured again after others.
bool comes_back(const RecognisedData& data, const RecognisedColumn& column);
/// Comment on a quantity that is fitted for each value of a label. @param why  "because they differ"; may be empty
std::string by_label_comment(const std::string& label, const std::string& why);

/// Where there is no column of readings: refuses a file that has one but for some of its cells, or for the units in
/// them.
void require_readable(const RecognisedData& data);
/// Refuses a column that a scenario needs as numbers and that has a cell of another kind. @param role  "readings"
void require_numbers(const RecognisedData& data, const RecognisedColumn& column, const std::string& role);

/// Whether positions are angles that go round, but for a tenth.
bool full_turn(const RecognisedData& data, const RecognisedColumn& position);
/// Whether the readings are the positions themselves, measured, and not their errors: then they span what the positions
/// span.
bool measured_position(const RecognisedData& data, const RecognisedColumn& position, const RecognisedColumn& reading);

/// An example of the model with what the card says of every quantity, and the data's columns in the place of its
/// readings and conditions.
std::string filled_in(const ModelCard& card, const std::string& example, const StarterData* data);

/// [data] with its units and conditions. @param used names of the columns that the scenario reads
std::string data_section(const StarterData& data, const NamedColumns& labels, const NamedColumns& conditions,
                         const std::set<std::string>& used);
/// `blocks` of [trace]: a label with enough values, or stretches.
std::string blocks_of(const RecognisedData& data, const NamedColumns& labels);
/// "time", or the name of the column that counts the readings in its place.
std::string course_name(const RecognisedColumn& time);
/// `order` and [trace.columns]: a time, temperatures and directions that are not conditions, whose columns it adds to
/// `used`, and `further` columns.
/// @param names of the scenario
/// @param order name of the condition that is the time; empty: none, and a column of times is the order
std::string columns_of(const RecognisedData& data, Names& names, std::set<std::string>& used,
                       const std::string& order = "", const NamedColumns& further = {});

} // namespace gumshoe::scenario
