#pragma once
/// Comma- or semicolon-separated values (RFC 4180): a header, then rows; every cell knows its place in the file.
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace gumshoe {

struct CsvCell {
  std::string text; ///< trimmed, unquoted
  int line = 0;
  int column = 0; ///< in bytes, from 1
  bool quoted = false;
};

struct Csv {
  std::string file;
  std::vector<CsvCell> header;
  std::vector<std::vector<CsvCell>> rows; ///< each as long as the header
  int comments_like_rows = 0;             ///< comments with as many cells as the header, of which one is a number

  Location at(const CsvCell& cell) const { return {file, cell.line, cell.column}; }
  /// Index of the column, or -1.
  int find(std::string_view name) const;
  std::vector<std::string> names() const; ///< column names, in order
  /// The cell as a finite number; throws InputError with the cell's location. `decimal`: its decimal sign, '.' or ','.
  double number(const CsvCell& cell, char decimal = '.') const;
};

/// Semicolons separate the cells if the header has one outside quotes and no comma. A line that begins with # is a
/// comment. Quoted cells may contain separators, doubled quotes and line ends; blank lines are skipped; a byte
/// order mark and CR LF are accepted. Throws InputError with every problem, located: no header, an
/// unnamed or repeated column, a row of another length, an unclosed quote.
Csv parse_csv(std::string_view text, const std::string& file);

/// parse_csv of a file; refuses files of more than `limit` bytes.
Csv read_csv(const std::string& path, std::size_t limit = std::size_t{1} << 30);

} // namespace gumshoe
