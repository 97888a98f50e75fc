#include "scenario/context.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/inputs.h"
#include "base/text_file.h"
#include "scenario/file_pattern.h"

namespace gumshoe::scenario {
namespace {
constexpr std::size_t largest_data_file = std::size_t{256} << 20;
}

DataFiles::DataFiles(const std::string& scenario_file, std::string of_readings, std::vector<std::string>& notes)
    : folder_(std::filesystem::path(scenario_file).parent_path().string()), of_readings_(std::move(of_readings)),
      notes_(notes) {}

const Csv* DataFiles::open(const Node& node, const std::string& path, const TextTable& form, Problems& problems) {
  const auto name = read_text(node, path, problems);
  if (!name) return nullptr;
  const std::string file = (std::filesystem::path(folder_) / *name).string();
  const auto no_file = [&](const Problem& p) {
    problems.add(node, fmt::format("{}: '{}': {}", path, file, p.what), p.why, p.remedy);
  };
  return open_table(file, form, no_file, problems);
}

const Csv* DataFiles::open_readings(const Node& node, const std::string& path, const TextTable& form,
                                    Problems& problems) {
  if (!readings_replaced()) return open(node, path, form, problems);
  const auto no_file = [&](const Problem& p) { problems.add(p); };
  return open_table(of_readings_, form, no_file, problems);
}

const Csv* DataFiles::open_table(const std::string& name, const TextTable& form, const NoFile& no_file,
                                 Problems& problems) {
  const auto [it, fresh] = tables_.try_emplace(name + '\n' + form.name);
  if (!fresh) return it->second.get();
  try {
    it->second = is_pattern(name) ? read_files(name, form) : read_file(name, form);
    if (const int like_rows = it->second->comments_like_rows; like_rows > 0)
      notes_.push_back(
          fmt::format("{}: {} line(s) that look like rows begin with # and are skipped as comments; a cell "
                      "that begins with # stands in quotes",
                      name, like_rows));
  } catch (const InputError& error) {
    for (const Problem& p : error.problems()) {
      if (p.where.line > 0)
        problems.add(p);
      else
        no_file(p);
    }
  }
  return it->second.get();
}

std::unique_ptr<Csv> DataFiles::read_file(const std::string& file, const TextTable& form) {
  auto known = std::ranges::find(files_, file, &File::name);
  if (known == files_.end()) known = files_.insert(files_.end(), {file, read_data_file(file, largest_data_file)});
  return std::make_unique<Csv>(form.parse(known->bytes, file));
}

std::unique_ptr<Csv> DataFiles::read_files(const std::string& pattern, const TextTable& form) {
  const FilePattern files(pattern);
  std::vector<Csv> parts;
  std::vector<std::pair<std::string, std::vector<std::string>>> columns;
  for (const std::string& name : files.names()) columns.push_back({name, {}});
  for (const FilePattern::Match& match : files.matches()) {
    parts.push_back(std::move(*read_file(match.file, form)));
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].second.push_back(match.texts[i]);
  }
  return std::make_unique<Csv>(join_csv(std::move(parts), pattern, columns));
}

void DataFiles::include(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(folder_) / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  inputs::note(path.string());
  std::ifstream in(path, std::ios::binary);
  // Not under its own name: it was not read as a table.
  files_.push_back({"model: " + path.string(), {std::istreambuf_iterator<char>(in), {}}});
}

void DataFiles::note(const std::string& text) {
  if (std::ranges::find(notes_, text) == notes_.end()) notes_.push_back(text);
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
