#pragma once
/// Logs that are no tables: a description, a TOML file, says which of their lines hold what.
#include <string>
#include <string_view>
#include <vector>

#include "base/csv.h"

namespace gumshoe::scenario {

/// A line of a log as a pattern: "G801 N{point} X{x} Y{y}". {name} is a cell, a number or a word; {} is one that is not
/// kept; blanks stand for any number of blanks, also none; everything else for itself.
class LinePattern {
public:
  /// Throws InputError: a brace that is not closed, or two names without anything between them.
  explicit LinePattern(const std::string& pattern);
  const std::vector<std::string>& names() const { return names_; }
  /// The cells of the line by names(), each with its place in it (from 1); false if the line is of another form.
  bool match(std::string_view line, std::vector<CsvCell>& cells) const;

private:
  std::vector<std::string> literals_; ///< before, between and after the gaps
  std::vector<std::string> gaps_, names_;
};

/// How a log becomes a table.
///
///     title   = "..."                # what it reads, from which source
///     comment = "%"                  # lines that begin so are skipped
///     marks   = "#"                  # characters behind a number that are no part of it
///     [[lines]]
///     pattern = "Date: {date}"       # kept for all rows that follow, until such a line comes again
///     [[lines]]
///     pattern = "G801 X{x} Y{y}"
///     row     = true                 # makes a row of what was kept
class LogForm {
public:
  /// Throws InputError with every problem of the description, located.
  LogForm(const std::string& text, const std::string& file);
  /// Lines of no form are skipped, and so are columns that no line holds. A row lacks no cell: one before its kept lines
  /// is a problem. Throws InputError, located.
  Csv read(std::string_view log, const std::string& file) const;

private:
  struct Line {
    LinePattern pattern;
    bool row = false;
    std::vector<std::size_t> columns = {}; ///< of the pattern's names
  };
  std::string comment_, marks_, file_;
  std::vector<Line> lines_;
  std::vector<std::string> columns_;
};

} // namespace gumshoe::scenario
