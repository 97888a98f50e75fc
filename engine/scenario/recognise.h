#pragma once
/// What the columns of a data file may be: guesses from their names and cells, for a first scenario (starter.h).
#include <string>
#include <utility>
#include <vector>

#include "base/csv.h"
#include "scenario/column_words.h"

namespace gumshoe::scenario {

/// What a role rests on: nothing, if there is none.
enum class Basis { nothing, name, cells, place, user };

struct RecognisedColumn {
  std::string name;
  std::string unit; ///< "1" of words, clock times and plain numbers; "?" where the header does not say it
  ColumnRole role = ColumnRole::other;
  bool number = false;                                    ///< all of its cells that are not empty
  bool gaps = false;                                      ///< it has empty cells
  bool unit_guessed = false;                              ///< from its numbers
  bool unit_told = false;                                 ///< by the user
  Basis basis = Basis::nothing;                           ///< of the role
  std::string why = {};                                   ///< in words: "by its name"
  std::string clock = {};                                 ///< form of its clock times (base/clock.h); empty: none
  std::string date = {};                                  ///< column of their dates; empty: they have them, or none
  std::vector<std::pair<std::string, double>> words = {}; ///< a direction's words and their signs
  bool sense = false;                                     ///< a direction that is the way the column's numbers go

  void take(ColumnRole taken, Basis on, std::string in_words) { role = taken, basis = on, why = std::move(in_words); }
  void leave() { take(ColumnRole::other, Basis::nothing, ""); }
};

struct RecognisedData {
  Csv csv;
  std::string delimiter;         ///< as [data] states it; empty: as the header shows
  std::string form;              ///< description of the log, as [data] states it; empty: it is a table
  int header = 0, first_row = 0; ///< lines of the names and of the first row, if [data] must state them; 0: not
  char decimal = '.';
  std::string rewritten; ///< the table, where the file has several runs in a row ("R1+", "R1-"): one row a reading
  std::vector<RecognisedColumn> columns;
  const RecognisedColumn* find(ColumnRole role) const; ///< the first one, or null
};

/// Reads the text of a data file; runs side by side are taken one after the other; lines before the names of columns,
/// and a line of units below them, are found. Throws InputError: no table, no rows, or a first row of numbers instead
/// of names.
RecognisedData recognise(const std::string& text, const std::string& file);

/// The same of a log that a description has read (log_form.h). `form`: its file, as [data] will state it.
RecognisedData recognise(Csv log, const std::string& form);

bool is_number(const Csv& csv, const CsvCell& cell, char decimal);

/// Position and reading, where there is none yet: the first column of numbers that is left, if it was set, and the
/// last that is no circumstance, if there is such a one. Without a time, a column that counts the readings stands for
/// it.
void guess_roles(RecognisedData& data);

/// The cells that keep a column, of which most are numbers, from being one of numbers: "OL", "1 000".
std::vector<const CsvCell*> cells_that_are_no_number(const RecognisedData& data, const RecognisedColumn& column);

/// The first cell of a column all of whose texts are a number and its unit, "25.0004 mm"; null: it is none such.
const CsvCell* cell_with_unit(const RecognisedData& data, const RecognisedColumn& column);

/// Successive rows that stand a second time in the file, alike in every cell, more of them than chance gives.
struct CopiedRows {
  std::size_t rows = 0;      ///< 0: none
  int first = 0, second = 0; ///< lines of the first of them
};
CopiedRows copied_rows(const Csv& csv);

/// Number of different texts in a column.
std::size_t different(const RecognisedData& data, const RecognisedColumn& column);

/// Whether the numbers of a column look set, not measured: they recur, or only rise, or only fall.
bool was_set(const RecognisedData& data, const RecognisedColumn& column);

/// Whether a column says at what a reading was taken, and is none itself, by its unit or name: a feed, a humidity.
bool is_circumstance(const RecognisedColumn& column);

/// Whether a column counts rows and measures nothing, by its name.
bool counts_rows(const RecognisedColumn& column);

/// Whether the numbers of a column are levels of something without a unit: stages 1 and 2, settings 200 and 300. They
/// are few, and each is met often.
bool names_levels(const RecognisedData& data, const RecognisedColumn& column);

/// Whether a column is the place of the readings along an axis, by its name: "Y".
bool is_coordinate(const RecognisedColumn& column);

/// Whether the numbers of a column name parts, people or places, by its name: "operator 2".
bool names_parts(const RecognisedColumn& column);

} // namespace gumshoe::scenario
