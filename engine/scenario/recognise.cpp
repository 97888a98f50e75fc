#include "scenario/recognise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "scenario/rtl_log.h"
#include "scenario/runs_in_rows.h"

namespace gumshoe::scenario {

bool is_number(const Csv& csv, const CsvCell& cell, char decimal) {
  try {
    csv.number(cell, decimal);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

namespace {

/// Whether the cells that are not missing are numbers, more than half of all.
bool numbers(const Csv& csv, std::size_t column, char decimal) {
  std::size_t n = 0;
  for (const auto& row : csv.rows) {
    if (says_missing(row[column].text)) continue;
    if (!is_number(csv, row[column], decimal)) return false;
    ++n;
  }
  return 2 * n > csv.rows.size();
}

std::size_t number_columns(const Csv& csv, char decimal) {
  std::size_t n = 0;
  for (std::size_t c = 0; c < csv.header.size(); ++c) n += numbers(csv, c, decimal);
  return n;
}

/// Whether the numbers of a column only rise, as times do.
bool rises(const RecognisedData& data, std::size_t column) {
  double last = -HUGE_VAL;
  for (const auto& row : data.csv.rows) {
    if (says_missing(row[column].text)) continue;
    const double x = data.csv.number(row[column], data.decimal);
    if (x <= last) return false;
    last = x;
  }
  return true;
}

/// Temperatures without a unit are in degC where they could be nothing else: a shop at 50 degF freezes.
bool in_degrees_celsius(const RecognisedData& data, std::size_t column) {
  return std::ranges::all_of(data.csv.rows, [&](const auto& row) {
    if (says_missing(row[column].text)) return true;
    const double x = data.csv.number(row[column], data.decimal);
    return x >= 10 && x <= 45;
  });
}

/// The form of clock times that are plain numbers, by their size: days of a spreadsheet or seconds of a computer from 1954
/// or 2001 on; empty if they are neither.
std::string clock_of_numbers(const RecognisedData& data, std::size_t column) {
  const auto within = [&](double low, double high) {
    return std::ranges::all_of(data.csv.rows, [&](const auto& row) {
      if (says_missing(row[column].text)) return false;
      const double x = data.csv.number(row[column], data.decimal);
      return x >= low && x < high;
    });
  };
  return within(2e4, 8e4) ? "excel" : within(1e9, 4e9) ? "%s" : "";
}

/// Takes a column of words for a time if its cells are clock times or days, and for cycles if they are days that recur:
/// "measured on" has no readings.
/// @param different  number of different texts
void take_times(RecognisedColumn& column, const std::vector<std::string>& texts, std::size_t different) {
  const bool named = column.role == ColumnRole::time;
  if (!named && column.role != ColumnRole::other && column.role != ColumnRole::reading &&
      column.role != ColumnRole::position)
    return;
  const bool days = are_dates(texts);
  const std::string form = clock_form(texts);
  if (days && 2 * different <= texts.size()) {
    column.take(ColumnRole::cycle, Basis::cells, "by its dates");
    column.clock = form;
  } else if (!form.empty()) {
    if (days || !named) column.take(ColumnRole::time, Basis::cells, days ? "by its dates" : "by its clock times");
    column.clock = form;
  } else if (days || named) {
    column.leave();
    column.why = why_no_clock(texts);
  }
}

/// @param below  unit below the name; empty: none
RecognisedColumn column_of(const RecognisedData& data, std::size_t c, const std::string& below) {
  RecognisedColumn out{data.csv.header[c].text, "1", ColumnRole::other, numbers(data.csv, c, data.decimal)};
  std::string rest;
  std::string unit = unit_in(out.name, rest);
  const auto words = words_of(rest);
  if (!below.empty()) unit = below;
  if (unit.empty()) unit = unit_by_name(words);
  // F is the farad, but not of a temperature.
  const bool letter = unit == "F" || (unit.empty() && !words.empty() && words.back() == "f");
  if (letter && (role_by_name(words, "") == ColumnRole::temperature || is_temperature_symbol(rest, ""))) unit = "degF";
  const bool symbol = out.number && is_temperature_symbol(rest, unit) && (!unit.empty() || !rises(data, c));
  if (const ColumnRole role = symbol ? ColumnRole::temperature : role_by_name(words, unit); role != ColumnRole::other)
    out.take(role, Basis::name, "by its name");
  std::vector<std::string> texts;
  for (const auto& row : data.csv.rows) texts.push_back(row[c].text);
  const std::set<std::string> different(texts.begin(), texts.end());
  if (out.number && unit == "degC" && out.role == ColumnRole::other)
    out.take(ColumnRole::temperature, Basis::name, "by its unit");
  if (out.role == ColumnRole::direction || out.role == ColumnRole::other) {
    out.words = signs(different);
    // Numbers are a direction only where both signs are there: a column of ones may be anything.
    const auto has = [&](double sign) {
      return std::ranges::count(out.words, sign, [](const auto& w) { return w.second; }) > 0;
    };
    if (out.number && out.role == ColumnRole::other && !(has(1) && has(-1))) out.words.clear();
    if (out.words.empty() && out.role == ColumnRole::direction && !out.number) out.leave();
    if (!out.words.empty() && out.role == ColumnRole::other)
      out.take(ColumnRole::direction, Basis::cells, out.number ? "by its signs" : "by its words");
  }
  if (!out.number) take_times(out, texts, different.size());
  if (out.number && out.role == ColumnRole::time && unit.empty())
    if (out.clock = clock_of_numbers(data, c); !out.clock.empty()) out.why += ", from a fixed day on by its size";
  out.gaps = out.number && std::ranges::any_of(different, says_missing);
  const bool plain = out.role == ColumnRole::cycle || out.role == ColumnRole::direction;
  if (out.number && !plain && out.clock.empty()) out.unit = unit.empty() ? "?" : unit;
  if (out.role == ColumnRole::temperature && out.unit == "?" && in_degrees_celsius(data, c)) {
    out.unit = "degC";
    out.unit_guessed = true;
    out.why += "; degC by its numbers";
  }
  return out;
}

/// A temperature whose unit is not told has that of the others, where these agree: one sensor of four was hotter.
void like_the_others(std::vector<RecognisedColumn>& columns) {
  std::set<std::string> units;
  const auto is_one = [](const RecognisedColumn& c) { return c.number && c.role == ColumnRole::temperature; };
  for (const RecognisedColumn& c : columns)
    if (is_one(c) && c.unit != "?") units.insert(c.unit);
  if (units.size() != 1) return;
  for (RecognisedColumn& c : columns) {
    if (!is_one(c) || c.unit != "?") continue;
    c.unit = *units.begin();
    c.unit_guessed = true;
    c.why += "; " + c.unit + " as the other temperatures";
  }
}

/// Line of the column names below other lines: the first that has as many cells as most lines have. 0: the first line,
/// or there is no table.
int line_of_names(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    lines.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  for (const char separator : {';', '\t', ','}) {
    std::map<std::size_t, std::size_t> count; // lines by number of separators
    const auto separators_in = [&](const std::string& l) {
      return static_cast<std::size_t>(std::ranges::count(l, separator));
    };
    for (const std::string& l : lines) ++count[separators_in(l)];
    const auto most = std::ranges::max_element(count, {}, [](const auto& c) { return c.second; });
    if (most == count.end() || most->first == 0 || 2 * most->second <= lines.size()) continue;
    const auto names = std::ranges::find(lines, most->first, separators_in);
    return static_cast<int>(names - lines.begin()) + 1;
  }
  return 0;
}

/// Takes a first row of units out of the table and into the names, as if it stood there: "pos [mm]".
std::map<std::string, std::string> take_units(RecognisedData& data) {
  std::map<std::string, std::string> out;
  auto& rows = data.csv.rows;
  if (rows.size() < 3) return out;
  for (std::size_t c = 0; c < data.csv.header.size(); ++c) {
    const CsvCell& cell = rows[0][c];
    if (cell.text.empty() || cell.text == "-") continue;
    if (is_number(data.csv, cell, '.') || is_number(data.csv, cell, ',')) return {};
    const std::string unit = unit_below(cell.text);
    if (unit.empty()) return {};
    out[data.csv.header[c].text] = unit;
  }
  if (out.empty()) return out;
  data.first_row = rows[1].front().line;
  const std::vector<CsvCell> units = rows.front(); // below a head that comes again, they come again, too
  std::erase_if(rows, [&](const auto& row) { return std::ranges::equal(row, units, {}, &CsvCell::text, &CsvCell::text); });
  return out;
}

std::vector<std::string> texts_of(const RecognisedData& data, const std::string& name) {
  const auto column = static_cast<std::size_t>(data.csv.find(name));
  std::vector<std::string> out;
  for (const auto& row : data.csv.rows) out.push_back(row[column].text);
  return out;
}

/// The texts of two columns, next to each other.
std::vector<std::string> joined(const RecognisedData& data, const std::string& first, const std::string& second) {
  std::vector<std::string> out = texts_of(data, first);
  const std::vector<std::string> rest = texts_of(data, second);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += ' ' + rest[i];
  return out;
}

/// Dates in a column of their own, next to the times of the day. Times of days that are not known are no times.
void find_dates(RecognisedData& data) {
  for (RecognisedColumn& time : data.columns) {
    if (time.clock.empty() || ClockFormat(time.clock).has_date()) continue;
    std::string unknown;
    for (RecognisedColumn& date : data.columns) {
      if (date.number || &date == &time || !date.words.empty()) continue;
      const std::vector<std::string> texts = joined(data, date.name, time.name);
      const std::string form = clock_form(texts);
      if (form.empty() && are_dates(texts_of(data, date.name))) unknown = why_no_clock(texts);
      if (form.empty()) continue;
      time.clock = form;
      time.date = date.name;
      if (time.role != ColumnRole::time) time.take(ColumnRole::time, Basis::cells, "by its clock times");
      date.take(ColumnRole::time, Basis::place, "with the column " + time.name);
      date.clock.clear();
      break;
    }
    if (!time.date.empty() || unknown.empty()) continue;
    time.take(ColumnRole::time, Basis::nothing, unknown); // and no label, though times of day recur
    time.clock.clear();
  }
}

/// Where several columns hold days, the last one is the time: a part is made before it is measured.
void one_time_of_days(RecognisedData& data) {
  const RecognisedColumn* last = nullptr;
  const auto is_days = [](const RecognisedColumn& c) {
    return c.role == ColumnRole::time && c.basis == Basis::cells && !c.number && !c.clock.empty() && c.date.empty();
  };
  for (const RecognisedColumn& c : data.columns)
    if (is_days(c)) last = &c;
  if (!last) return;
  for (RecognisedColumn& c : data.columns)
    if (is_days(c) && &c != last) {
      c.leave();
      c.clock.clear();
      c.why = "the time is " + last->name;
    }
}

Csv table_of(const std::string& text, const std::string& file, RecognisedData& out) {
  try {
    return parse_csv(text, file);
  } catch (const InputError&) {
    out.header = line_of_names(text);
    if (out.header <= 1) throw;
    return parse_csv(text, file, {.header = out.header});
  }
}

} // namespace

const RecognisedColumn* RecognisedData::find(ColumnRole role) const {
  const auto it = std::ranges::find_if(columns, [&](const RecognisedColumn& c) {
    return c.role == role && (role != ColumnRole::time || c.number || !c.clock.empty());
  });
  return it == columns.end() ? nullptr : &*it;
}

namespace {

/// What each column of the table may be.
void recognise_columns(RecognisedData& out) {
  const auto below = out.form.empty() ? take_units(out) : std::map<std::string, std::string>{};
  if (number_columns(out.csv, ',') > number_columns(out.csv, '.')) out.decimal = ',';
  for (std::size_t c = 0; c < out.csv.header.size(); ++c) {
    const auto unit = below.find(out.csv.header[c].text);
    out.columns.push_back(column_of(out, c, unit == below.end() ? "" : unit->second));
  }
  like_the_others(out.columns);
  find_dates(out);
  one_time_of_days(out);
  guess_roles(out);
}

} // namespace

RecognisedData recognise(Csv log, const std::string& form) {
  RecognisedData out;
  out.csv = std::move(log);
  out.form = form;
  recognise_columns(out);
  return out;
}

RecognisedData recognise(const std::string& text, const std::string& file) {
  if (std::string rows = rows_of_rtl(text); !rows.empty()) {
    RecognisedData log = recognise(rows, file);
    log.rewritten = std::move(rows);
    return log;
  }
  RecognisedData out;
  out.csv = table_of(text, file, out);
  if (out.csv.header.size() == 1 && words_of(out.csv.header[0].text).size() > 1) try { // blanks, if they make a table
      Csv blanks = parse_csv(text, file, {.separator = ' '});
      if (blanks.header.size() > 1) out.csv = std::move(blanks), out.delimiter = "blanks";
    } catch (const InputError&) {
    }
  if (out.csv.rows.empty()) throw InputError(file + ": the file has no rows", "", "write rows under the header");
  const auto is_value = [&](const CsvCell& c) {
    return is_number(out.csv, c, '.') || is_number(out.csv, c, ',') || !clock_form({c.text}).empty();
  };
  if (std::ranges::all_of(out.csv.header, is_value))
    throw InputError({{out.csv.at(out.csv.header.front()), "the first row holds numbers or dates, not names of columns",
                       out.header > 1 ? "the lines above it have another number of cells" : "",
                       out.header > 1 ? "write a name for each column, in quotes where it holds the separator"
                                      : "write a line with a name for each column above it"}});
  if (std::string rows = below_each_other(out.csv); !rows.empty()) {
    RecognisedData apart = recognise(rows, file);
    apart.rewritten = std::move(rows);
    return apart;
  }
  recognise_columns(out);
  return out;
}

} // namespace gumshoe::scenario
