#pragma once
/// Columns of a data file as numbers in SI: plain numbers, words that stand for numbers, and clock times.
#include "scenario/data_file.h"

namespace gumshoe::scenario {

/// Keys of { column, unit }, { column, map = { fwd = 1, bwd = -1 } }, { column, clock = "iso" } and
/// { column, sense = true }.
std::vector<Key> number_column_keys();
/// Such a table, or the column's name alone.
Shape number_column_shape();

/// { column = "x" } for the name of a column alone; a table as it is.
Node column_table(const Node& node);

/// The unit of such a column as its table says it, or as `units` do (by column); "s" for clock times, empty without
/// one.
std::string unit_of_column(const Node& node, const std::map<std::string, std::string>& units);
/// The key `units` of [data], unchecked.
std::map<std::string, std::string> stated_units(const Node* data);

class NumberColumn {
public:
  /// Reads `key` of the table. The numbers must have the dimension; one without an SI unit stands for any. Nothing, and
  /// problems, if something is wrong.
  static std::optional<NumberColumn> read(Table& table, const std::string& key, const DataFile& file,
                                          const Dimension& dimension = {});
  /// The numbers of these rows in SI; nothing where a cell is wrong, with a problem at its place. Clock times are
  /// seconds since the key `since`, or the earliest of the rows. Times without a date go on after midnight: one more
  /// than half a day below the row before it is of the next day. A sense is that from row to row of these.
  std::vector<std::optional<double>> values(const std::vector<std::size_t>& rows, Problems& problems) const;
  const std::string& unit() const { return unit_; }
  const std::string& si_unit() const { return dimension_.si_unit; }
  const std::string& name() const { return name_; } ///< of the column

private:
  NumberColumn(const DataFile& file, const Dimension& dimension) : file_(file), dimension_(dimension) {}
  bool read_columns(Table& table);
  bool read_unit(Table& table);
  void read_map(Table& table);
  void read_clock(Table& table);
  void read_sense(Table& table);
  std::vector<std::optional<double>> clock_values(const std::vector<std::size_t>& rows, Problems& problems) const;
  std::vector<std::optional<double>> sense_values(const std::vector<std::size_t>& rows, Problems& problems) const;
  /// Whether all these cells are clock times, or words of a direction; says how to read them.
  bool no_numbers(const std::vector<std::size_t>& rows, Problems& problems) const;
  void refuse_missing(const std::string& text, const std::vector<std::size_t>& rows, Problems& problems) const;
  std::string text_at(std::size_t row) const;

  DataFile file_;
  Dimension dimension_;
  std::string name_, unit_, clock_, since_, path_;
  bool sense_ = false;               ///< not the numbers, but the way they go
  std::vector<std::size_t> columns_; ///< of a clock time maybe two, date and time
  std::map<std::string, double> words_;
};

} // namespace gumshoe::scenario
