/// Data files: encoding, cells, numbers and clock times, in every layout that a scenario can ask for.
#include "base/csv.h"

#include <algorithm>

#include "base/clock.h"
#include "base/encoding.h"
#include "fuzz/harness.h"

namespace gumshoe::fuzz {
namespace {

void number(const Csv& table, const CsvCell& cell, char decimal) {
  try {
    table.number(cell, decimal);
  } catch (const InputError&) {
  }
}

void check_cells(const Csv& table) {
  for (const auto& row : table.rows) {
    require(row.size() == table.header.size(), "each row is as long as the header");
    for (const CsvCell& cell : row) require(cell.line > 0 && cell.column > 0, "every cell knows its place");
  }
}

void read_cells(const Csv& table) {
  static const ClockFormat iso("iso"), own("%d.%m.%Y %I:%M:%S %p"), month("%b %d %y %H:%M:%S"), since("%s");
  int left = 40; // a refusal takes its time, and more cells of one input show nothing new
  for (const auto& row : table.rows) {
    for (const CsvCell& cell : row) {
      if (--left < 0) return;
      number(table, cell, '.'), number(table, cell, ',');
      for (const ClockFormat* format : {&iso, &own, &month, &since}) format->parse(cell.text);
    }
  }
}

void read(const std::string& text, const CsvLayout& layout) {
  try {
    const Csv table = parse_csv(text, "data.csv", layout);
    check_cells(table);
    if (layout.separator == '\0') read_cells(table);
    for (const CsvCell& cell : table.header) require(table.find(cell.text) >= 0, "every column is found by its name");
    check_cells(join_csv({table, table}, "data*.csv", {{"run", {"1", "2"}}}));
  } catch (const InputError&) { // the next layout may fit
  }
}

} // namespace

void csv(std::string_view input) {
  const std::string text = as_utf8(std::string(input));
  require(as_utf8(text) == text, "what became UTF-8 is UTF-8");
  for (const char separator : {'\0', ',', ';', '\t', ' '}) read(text, {separator});
  read(text, {'\0', 2, 4});
  const std::size_t line = std::min(text.find('\n'), text.size());
  try { // the first line may also be the pattern of a clock, for the second
    ClockFormat(text.substr(0, line)).parse(text.substr(std::min(line + 1, text.size())));
  } catch (const InputError&) {
  }
}

} // namespace gumshoe::fuzz
