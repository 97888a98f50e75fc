#pragma once
/// The rows of a data file that `where` selects.
#include "scenario/context.h"

namespace gumshoe::scenario {

/// `where` = { axis = "X", run = ["1", "2"], setup = { not = "3" } }: rows by the texts of their cells.
class RowFilter {
public:
  /// Name to column.
  using Columns = std::vector<std::pair<std::string, std::size_t>>;
  RowFilter() = default; ///< keeps every row
  /// Adds the key `where` of the table, if there is one; a name that `labels` lacks is a column of the file.
  void add(Table& table, const Csv& csv, const Columns& labels);
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

} // namespace gumshoe::scenario
