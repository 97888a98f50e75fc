#pragma once
/// Columns of data files, and the rows of them that `where` selects.
#include "scenario/context.h"

namespace gumshoe::scenario {

/// A column of a data file in SI: { file = "...", column = "...", unit = "...", decimal = "," }.
struct DataColumn {
  const Csv* csv = nullptr;
  int column = -1;
  std::string unit;
  char decimal = '.';
};
std::vector<Key> data_column_keys();
/// Column and unit alone.
std::vector<Key> column_keys();
/// Finds the column named by `key` of the table; -1 and a problem if it is not there.
int find_column(Table& table, const std::string& key, const Csv& csv);
/// The key `decimal`; '.' without it.
char read_decimal(Table& table);
/// Reads file, column, unit and decimal; nullopt and problems if something is wrong.
std::optional<DataColumn> read_data_column(Table& table, const std::string& si_unit, DataFiles& files,
                                           bool of_readings = false);
/// A cell in SI; nullopt and a problem located in the data file.
std::optional<double> read_cell(const Csv& csv, const CsvCell& cell, const std::string& unit, char decimal,
                                const Dimension& dimension, Problems& problems);

/// `where` = { axis = "X", run = ["1", "2"], setup = { not = "3" } }: rows by the texts of their cells.
class RowFilter {
public:
  /// Name to column.
  using Columns = std::vector<std::pair<std::string, std::size_t>>;
  RowFilter() = default; ///< keeps every row
  /// Reads the key `where` of the table, if there is one; a name that `labels` lacks is a column of the file.
  RowFilter(Table& table, const Csv& csv, const Columns& labels);
  /// Whether the row has what is asked of its labels, and of other columns.
  bool keeps_labels(const std::vector<CsvCell>& row) const { return keeps(row, true); }
  bool keeps_columns(const std::vector<CsvCell>& row) const { return keeps(row, false); }
  /// Labels of which a single value is left.
  quantities::Labels fixed() const;
  std::string text() const; ///< "rod = a, setup = 1 or 2": for messages

private:
  struct Rule {
    std::string name;
    std::size_t column = 0;
    bool label = false, excluded = false;
    std::vector<std::string> texts;
  };
  void read_rule(Table& where, const Member& member, const Csv& csv, const Columns& labels);
  bool keeps(const std::vector<CsvCell>& row, bool labels) const;
  std::vector<Rule> rules_;
};
Key where_key();
Shape where_shape(); ///< that the key refers to

/// A list of numbers with units, or a column of a data file: { file, column, unit, decimal, where }.
Shape series_shape();
/// Reads it from the key; nullopt and problems if something is wrong or it is absent.
std::optional<std::vector<double>> read_series(Table& table, const std::string& key, const Dimension& dimension,
                                               Context& context);

} // namespace gumshoe::scenario
