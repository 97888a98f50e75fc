#pragma once
/// Values separated by commas, semicolons, tabs or blanks (RFC 4180): a header, then rows; every cell knows its place in the file.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace gumshoe {

struct CsvCell {
  std::string text; ///< trimmed, unquoted
  int line = 0;
  int column = 0; ///< in bytes, from 1
  bool quoted = false;
  int part = 0; ///< of a table joined from several files: which one
};

struct Csv {
  std::string file;
  std::vector<CsvCell> header;
  std::vector<std::vector<CsvCell>> rows; ///< each as long as the header
  int comments_like_rows = 0;             ///< comments with as many cells as the header, of which one is a number
  std::vector<std::string> parts = {}; ///< files of a joined table, in the order of their rows; empty: one file

  Location at(const CsvCell& cell) const {
    return {parts.empty() ? file : parts[static_cast<std::size_t>(cell.part)], cell.line, cell.column};
  }
  /// Index of the column, or -1.
  int find(std::string_view name) const;
  std::vector<std::string> names() const; ///< column names, in order
  /// The cell as a finite number, "1.234,5" as well, and with spaces around it, no-break ones too; throws InputError
  /// with its location. `decimal`: its sign, '.' or ','.
  double number(const CsvCell& cell, char decimal = '.') const;
};

/// Where the table stands in its file.
struct CsvLayout {
  char separator = '\0';
  int header = 0; ///< line of the column names, from 1; 0: the first with a text
  int rows = 0;   ///< line of the first row; 0: the next after the names
};

/// `separator`: ',', ';', '\t', or ' ' for any number of blanks. '\0' takes it from a first line `sep=;`, or from the
/// header: a comma if it has one outside quotes, otherwise a semicolon or a tab. A line that begins with # is a
/// comment. Quoted cells may contain separators, doubled quotes and line ends; empty rows and heads that come again are
/// skipped; a BOM and CR LF are accepted. Throws InputError with every problem, located: no header, an unnamed or
/// repeated column, a row of another length, an unclosed quote. A last column without a name and without any text is
/// none: lines may end with a separator, all of them or the rows alone.
Csv parse_csv(std::string_view text, const std::string& file, const CsvLayout& layout = {});

/// A table of the parts' rows, one after the other. Columns are matched by name to those of the first part; further ones
/// are left out. `added`: names of columns that come first, and their text in each part. Throws InputError where a part
/// lacks a column, or has one that `added` names.
Csv join_csv(std::vector<Csv> parts, const std::string& name,
             const std::vector<std::pair<std::string, std::vector<std::string>>>& added);

/// A cell as a table takes it: between quotes, its own doubled; csv_cell only where it must be.
std::string csv_quoted(const std::string& text);
std::string csv_cell(const std::string& text, char separator = ',');

/// parse_csv of a file; refuses files of more than `limit` bytes.
Csv read_csv(const std::string& path, std::size_t limit = std::size_t{1} << 30);

} // namespace gumshoe
