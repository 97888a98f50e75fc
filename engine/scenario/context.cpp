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

DataFiles::DataFiles(const std::string& scenario_file, std::string of_readings, std::vector<std::string>& notes)
    : folder_(std::filesystem::path(scenario_file).parent_path().string()), of_readings_(std::move(of_readings)),
      notes_(notes) {}

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
    if (const int like_rows = files_.back().csv->comments_like_rows; like_rows > 0)
      notes_.push_back(fmt::format("{}: {} line(s) that look like rows begin with # and are skipped as comments; a cell "
                                   "that begins with # stands in quotes",
                                   file, like_rows));
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
