#pragma once
/// Data files: which file, how its text is read, and units of its columns.
#include "scenario/context.h"

namespace gumshoe::scenario {

struct DataFile {
  const Csv* csv = nullptr;
  char decimal = '.';
  std::map<std::string, std::string> units = {}; ///< by column, from [data]
  DataFiles* files = nullptr;                    ///< which take notes on it
};

/// The keys file, delimiter and decimal.
std::vector<Key> data_file_keys();
/// Reads them; nullopt and problems if something is wrong. `of_readings`: another file may stand for it (--data).
std::optional<DataFile> read_data_file(Table& table, DataFiles& files, bool of_readings = false);

/// The key `units` of [data]: column = unit.
Key units_key();
std::map<std::string, std::string> read_units(Table& data, const Csv& csv);

/// Index of the column named by `key` of the table; -1 and a problem if it is not there.
int find_column(Table& table, const std::string& key, const Csv& csv);

/// A cell of the column in SI; nullopt and a problem located in the data file.
std::optional<double> read_cell(const DataFile& file, const CsvCell& cell, const std::string& column,
                                const std::string& unit, const Dimension& dimension, Problems& problems);

/// Notes that the column is read in `unit` although its name states one of the same kind and another size: "x_um" in
/// mm.
void note_other_unit(const DataFile& file, const std::string& column, const std::string& unit,
                     const std::string& si_unit);

/// The unit "?", which stands for one that is still to be told.
bool is_unknown_unit(const std::string& unit);
/// True, and a problem, if it is that unit.
bool unknown_unit(const Node& node, const std::string& path, const std::string& unit, const std::string& column,
                  Problems& problems);

} // namespace gumshoe::scenario
