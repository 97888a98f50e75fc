#include "scenario/data_file.h"

#include <array>

#include <fmt/format.h>

namespace gumshoe::scenario {
namespace {

constexpr std::array separators{',', ';', '\t', ' '};
const std::vector<std::string> separator_words{",", ";", "tab", "blanks"};

TextTable text_table(Table& table) {
  const auto index = table.choice("delimiter", separator_words);
  if (!index) return {};
  const char separator = separators[*index];
  return {separator_words[*index],
          [separator](std::string_view text, const std::string& file) { return parse_csv(text, file, separator); }};
}

} // namespace

std::vector<Key> data_file_keys() {
  return {
      {"file", shape::text(),
       "data file, relative to the scenario. Several files as one: * in the name stands for any text, and {run} for "
       "any text that becomes the column `run`"},
      {"delimiter", shape::words(separator_words), "what separates the cells; default: as the header shows"},
      {"decimal", shape::words({".", ","}), "decimal sign of the numbers in the file", false, "\".\""}};
}

std::optional<DataFile> read_data_file(Table& table, DataFiles& files, bool of_readings) {
  const Node* const name = table.require("file");
  const TextTable form = text_table(table);
  DataFile out;
  out.decimal = table.choice("decimal", {".", ","}).value_or(0) == 1 ? ',' : '.';
  if (name)
    out.csv = of_readings ? files.open_readings(*name, table.path("file"), form, table.problems())
                          : files.open(*name, table.path("file"), form, table.problems());
  if (!out.csv) return std::nullopt;
  return out;
}

Key units_key() {
  return {"units", shape::map(shape::text()), "column = unit, for whoever refers to the column without one"};
}

std::map<std::string, std::string> read_units(Table& data, const Csv& csv) {
  std::map<std::string, std::string> out;
  auto units = data.table("units");
  if (!units) return out;
  for (const Member& m : units->members()) {
    const auto unit = read_text(m.value, units->path(m.key), units->problems());
    if (csv.find(m.key) < 0)
      units->problems().add(m, fmt::format("{}: '{}' has no column '{}'", units->path(), csv.file, m.key), "",
                            did_you_mean(m.key, csv.names()));
    else if (unit && !unknown_unit(m.value, units->path(m.key), *unit, m.key, units->problems()) &&
             read_si_unit(m.value, units->path(m.key), *unit, units->problems()))
      out[m.key] = *unit;
  }
  return out;
}

int find_column(Table& table, const std::string& key, const Csv& csv) {
  const auto name = table.text(key);
  if (!name) return -1;
  const int column = csv.find(*name);
  if (column < 0)
    table.refuse_key(key, fmt::format("'{}' has no column '{}'", csv.file, *name), "",
                     did_you_mean(*name, csv.names()));
  return column;
}

std::optional<double> read_cell(const DataFile& file, const CsvCell& cell, const std::string& unit,
                                const Dimension& dimension, Problems& problems) {
  try {
    return units::to_si(file.csv->number(cell, file.decimal), unit, dimension.si_unit, dimension.kind);
  } catch (const InputError& error) {
    problems.add(error);
    return std::nullopt;
  }
}

bool is_unknown_unit(const std::string& unit) { return unit == "?"; }

bool unknown_unit(const Node& node, const std::string& path, const std::string& unit, const std::string& column,
                  Problems& problems) {
  if (!is_unknown_unit(unit)) return false;
  problems.add(node, fmt::format("{}: the unit of the column '{}' is still to be told", path, column),
               "the file does not say it", "write it instead of the question mark, such as \"mm\"");
  return true;
}

} // namespace gumshoe::scenario
