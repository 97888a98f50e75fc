#include "scenario/file_pattern.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"

namespace gumshoe::scenario {
namespace {

constexpr std::size_t longest_name = 255; ///< bytes that a file system gives a name
constexpr const char* name_remedy = "write a name such as \"axis_{run}.csv\"";

bool digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The number that begins at `at`, without leading zeros; moves `at` behind it.
std::string digits_at(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && digit(text[at])) ++at;
  const std::size_t first = std::min(text.find_first_not_of('0', begin), at);
  return text.substr(first, at - first);
}

/// run2 before run10.
bool before(const std::string& a, const std::string& b) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (digit(a[i]) && digit(b[j])) {
      const std::string x = digits_at(a, i), y = digits_at(b, j);
      if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i, ++j;
    }
  }
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

} // namespace

bool is_pattern(const std::string& name) {
  std::error_code ignored;
  return name.find_first_of("*{") != std::string::npos && !std::filesystem::exists(name, ignored);
}

FilePattern::FilePattern(const std::string& pattern) : pattern_(pattern) {
  const std::filesystem::path path(pattern);
  folder_ = path.parent_path().string();
  if (folder_.find_first_of("*{") != std::string::npos)
    throw InputError("the folder's name is a pattern", "only the file's own name may be one", name_remedy);
  const std::string name = path.filename().string();
  if (name.size() > longest_name)
    throw InputError("the file's name is too long", fmt::format("it may have {} bytes", longest_name), name_remedy);
  fixed_.emplace_back();
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != '*' && name[i] != '{') {
      fixed_.back() += name[i];
      continue;
    }
    int gap = -1;
    if (name[i] == '{') {
      const std::size_t end = name.find('}', i);
      const std::string label = end == std::string::npos ? "" : name.substr(i + 1, end - i - 1);
      if (label.empty()) throw InputError("a brace is not closed, or holds no name", "", name_remedy);
      if (std::ranges::find(names_, label) != names_.end())
        throw InputError(fmt::format("'{{{}}}' stands there twice", label), "", name_remedy);
      gap = static_cast<int>(names_.size());
      names_.push_back(label);
      i = end;
    }
    gaps_.push_back(gap);
    fixed_.emplace_back();
  }
}

bool FilePattern::match(const std::string& name, std::size_t piece, std::size_t at, Tried& tried, Match& out) const {
  if (!tried.insert({piece, at}).second) return false; // *a*a*a*a has very many ways to the same place
  if (!name.substr(at).starts_with(fixed_[piece])) return false;
  at += fixed_[piece].size();
  if (piece == gaps_.size()) return at == name.size();
  for (std::size_t end = at; end <= name.size(); ++end) { // the shortest text
    if (!match(name, piece + 1, end, tried, out)) continue;
    if (gaps_[piece] >= 0) out.texts[static_cast<std::size_t>(gaps_[piece])] = name.substr(at, end - at);
    return true;
  }
  return false;
}

std::vector<FilePattern::Match> FilePattern::matches() const {
  std::vector<std::string> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.empty() ? "." : folder_, none))
    if (entry.is_regular_file(none)) files.push_back(entry.path().filename().string());
  std::ranges::sort(files, before);
  std::vector<Match> out;
  for (const std::string& file : files) {
    Match m{(std::filesystem::path(folder_) / file).string(), std::vector<std::string>(names_.size())};
    Tried tried;
    if (match(file, 0, 0, tried, m)) out.push_back(std::move(m));
  }
  if (out.empty()) throw InputError("no file has such a name", "", name_remedy);
  return out;
}

} // namespace gumshoe::scenario
