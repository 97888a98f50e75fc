#include "scenario/context.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text_file.h"

namespace gumshoe::scenario {
namespace {
constexpr std::size_t largest_data_file = std::size_t{256} << 20;
}

DataFiles::DataFiles(const std::string& scenario_file, std::string of_readings)
    : folder_(std::filesystem::path(scenario_file).parent_path().string()), of_readings_(std::move(of_readings)) {}

const Csv* DataFiles::open(const Node& node, const std::string& path, Problems& problems) {
  const auto name = read_text(node, path, problems);
  if (!name) return nullptr;
  const std::string file = (std::filesystem::path(folder_) / *name).string();
  const auto no_file = [&](const Problem& p) {
    problems.add(node, fmt::format("{}: '{}': {}", path, file, p.what), p.why, p.remedy);
  };
  return open_file(file, no_file, problems);
}

const Csv* DataFiles::open_readings(const Node& node, const std::string& path, Problems& problems) {
  if (!readings_replaced()) return open(node, path, problems);
  const auto no_file = [&](const Problem& p) { problems.add(p); };
  return open_file(of_readings_, no_file, problems);
}

const Csv* DataFiles::open_file(const std::string& file, const std::function<void(const Problem&)>& no_file,
                                Problems& problems) {
  for (const File& f : files_)
    if (f.name == file) return f.csv.get();
  files_.push_back({file, {}, nullptr});
  try {
    files_.back().bytes = read_text_file(file, largest_data_file);
    files_.back().csv = std::make_unique<Csv>(parse_csv(files_.back().bytes, file));
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) {
      if (p.where.line > 0)
        problems.add(p);
      else
        no_file(p);
    }
  }
  return files_.back().csv.get();
}

void DataFiles::include(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(folder_) / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  std::ifstream in(path, std::ios::binary);
  // Not under its own name: it was not read as a table.
  files_.push_back({"model: " + path.string(), {std::istreambuf_iterator<char>(in), {}}, nullptr});
}

std::uint64_t DataFiles::hash(std::uint64_t hash) const {
  for (const File& file : files_) hash = hash64(file.bytes, hash);
  return hash;
}

std::vector<Key> column_keys() {
  return {{"column", shape::text(), "column name in the first row of the file", true},
          {"unit", shape::text(), "unit of the numbers in the column; default: a plain number"}};
}

std::vector<Key> data_column_keys() {
  std::vector<Key> keys = column_keys();
  keys.insert(keys.begin(), {"file", shape::text(), "CSV file, relative to the scenario", true});
  return keys;
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

std::optional<DataColumn> read_data_column(Table& table, const std::string& si_unit, DataFiles& files,
                                           bool of_readings) {
  DataColumn out;
  const Node* file = table.require("file");
  const Node* column = table.require("column");
  const auto unit = table.text("unit");
  if (file)
    out.csv = of_readings ? files.open_readings(*file, table.path("file"), table.problems())
                          : files.open(*file, table.path("file"), table.problems());
  if (!table.has("unit") && si_unit != "1")
    table.add(fmt::format("{} is missing", table.path("unit")), "numbers in a column carry no unit", "unit = \"mm\"");
  out.unit = unit.value_or("1");
  const bool known = table.has("unit") ? unit && units::convertible(out.unit, si_unit) : si_unit == "1";
  if (unit && !known) {
    try {
      units::to_si(0, *unit, si_unit);
    } catch (const InputError& error) {
      table.problems().add(*table.find("unit"), table.path("unit"), error);
    }
  }
  if (out.csv && column) out.column = find_column(table, "column", *out.csv);
  if (out.column < 0 || !known) return std::nullopt;
  return out;
}

std::optional<double> read_cell(const Csv& csv, const CsvCell& cell, const std::string& unit,
                                const Dimension& dimension, Problems& problems) {
  try {
    return units::to_si(csv.number(cell), unit, dimension.si_unit, dimension.kind);
  } catch (const InputError& error) {
    problems.add(error);
    return std::nullopt;
  }
}

std::vector<std::string> Context::label_names() const {
  std::vector<std::string> names;
  for (const auto& [name, values] : label_values) names.push_back(name);
  return names;
}

bool Context::is_label(const Node& node, const std::string& path, const std::string& name) const {
  if (!readings_known || label_values.contains(name)) return true;
  problems.add(node, fmt::format("{}: no reading has the label '{}'", path, name), "",
               did_you_mean(name, label_names()));
  return false;
}

void Context::note(const std::string& text) const {
  if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
}

std::string text_of(const quantities::Labels& labels) {
  std::string out;
  for (const auto& [key, value] : labels) out += (out.empty() ? "" : ", ") + key + " = " + value;
  return out;
}

} // namespace gumshoe::scenario
