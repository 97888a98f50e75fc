#include "scenario/data_file.h"

#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/text_file.h"
#include "scenario/column_words.h"
#include "scenario/log_form.h"

namespace gumshoe::scenario {
namespace {

constexpr std::size_t largest_form = std::size_t{1} << 20;
constexpr std::int64_t last_line = 1'000'000'000;
constexpr std::array separators{',', ';', '\t', ' '};
const std::vector<std::string> separator_words{",", ";", "tab", "blanks"};

/// The description of a log; nothing and problems if it is wrong.
std::optional<TextTable> log_table(Table& table, DataFiles& files) {
  const auto name = table.text("form");
  for (const char* key : {"delimiter", "header", "first_row"})
    if (table.has(key))
      table.refuse_key(key, "given together with form", "the description says where the table stands", "leave it out");
  if (!name) return std::nullopt;
  const std::string path = (std::filesystem::path(table.problems().file()).parent_path() / *name).string();
  try {
    const LogForm form(read_text_file(path, largest_form), path);
    files.include(*name);
    return TextTable{*name, [form](std::string_view text, const std::string& file) { return form.read(text, file); }};
  } catch (const InputError& error) {
    for (const Problem& p : error.problems())
      p.where.line > 0 ? table.problems().add(p)
                       : table.refuse_key("form", fmt::format("'{}': {}", path, p.what), p.why, p.remedy);
  }
  return std::nullopt;
}

std::optional<TextTable> text_table(Table& table, DataFiles& files) {
  if (table.has("form")) return log_table(table, files);
  const auto index = table.choice("delimiter", separator_words);
  CsvLayout layout;
  if (index) layout.separator = separators[*index];
  layout.header = static_cast<int>(table.integer("header", 1, last_line).value_or(0));
  layout.rows = static_cast<int>(table.integer("first_row", layout.header + 1, last_line).value_or(0));
  if (!index && layout.header == 0 && layout.rows == 0) return TextTable{};
  const std::string name = fmt::format("{} {} {}", index ? separator_words[*index] : "", layout.header, layout.rows);
  return TextTable{name,
                   [layout](std::string_view text, const std::string& file) { return parse_csv(text, file, layout); }};
}

} // namespace

std::vector<Key> data_file_keys() {
  return {
      {"file", shape::text(),
       "data file, relative to the scenario. Several files as one: * in the name stands for any text, and {run} for "
       "any text that becomes the column `run`"},
      {"form", shape::text(),
       "description of a log that is no table, relative to the scenario: a TOML file of the patterns of its lines"},
      {"delimiter", shape::words(separator_words), "what separates the cells; default: as the header shows"},
      {"header", shape::whole(1, last_line), "line of the column names; default: the first that is no comment"},
      {"first_row", shape::whole(1, last_line),
       "line of the first row, where lines such as units follow the names; default: the next line"},
      {"decimal", shape::words({".", ","}), "decimal sign of the numbers in the file", false, "\".\""}};
}

std::optional<DataFile> read_data_file(Table& table, DataFiles& files, bool of_readings) {
  const Node* const name = table.require("file");
  const auto form = text_table(table, files);
  DataFile out;
  out.decimal = table.choice("decimal", {".", ","}).value_or(0) == 1 ? ',' : '.';
  if (name && form)
    out.csv = of_readings ? files.open_readings(*name, table.path("file"), *form, table.problems())
                          : files.open(*name, table.path("file"), *form, table.problems());
  if (!out.csv) return std::nullopt;
  out.files = &files;
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

std::optional<double> read_cell(const DataFile& file, const CsvCell& cell, const std::string& column,
                                const std::string& unit, const Dimension& dimension, Problems& problems) {
  try {
    const double number = file.csv->number(cell, file.decimal);
    require_possible_temperature(number, unit, dimension);
    return units::to_si(number, unit, dimension.si_unit, dimension.kind);
  } catch (const InputError& error) {
    for (Problem p : error.problems()) {
      if (p.where.line == 0) p.where = file.csv->at(cell);
      p.why = fmt::format("column '{}'{}{}", column, p.why.empty() ? "" : ": ", p.why);
      problems.add(std::move(p));
    }
    return std::nullopt;
  }
}

namespace {

/// As differences: those of temperatures in degC are read in K.
bool are_alike(const std::string& a, const std::string& b, const std::string& si_unit) {
  const auto one = [&](const std::string& unit) { return units::to_si(1, unit, si_unit, units::Kind::difference); };
  return std::abs(one(a) / one(b) - 1) < 1e-9;
}

} // namespace

void note_other_unit(const DataFile& file, const std::string& column, const std::string& unit,
                     const std::string& si_unit) {
  std::string rest;
  const std::string named = unit_in(column, rest);
  if (named.empty() || named == "1" || !units::convertible(named, si_unit)) return;
  if (!are_alike(named, unit, si_unit))
    file.files->note(
        fmt::format("{}: column '{}' is read in {}, but its name states {}", file.csv->file, column, unit, named));
}

bool is_unknown_unit(const std::string& unit) { return unit == "?"; }

bool unknown_unit(const Node& node, const std::string& path, const std::string& unit, const std::string& column,
                  Problems& problems) {
  if (!is_unknown_unit(unit)) return false;
  problems.add(node, fmt::format("{}: the unit of the column '{}' is still to be told", path, column),
               "the file does not say it",
               "write it instead of the question mark, such as \"mm\", or \"1\" for numbers without one");
  return true;
}

} // namespace gumshoe::scenario
