#include "scenario/log_form.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/reader.h"

namespace gumshoe::scenario {
namespace {

constexpr std::size_t most_problems = 20;

bool blank(char c) { return c == ' ' || c == '\t'; }

/// Goes over a literal; a blank in it stands for any number of blanks. False if the line has something else.
bool pass(std::string_view line, std::size_t& at, const std::string& literal) {
  for (const char c : literal) {
    if (blank(c)) {
      while (at < line.size() && blank(line[at])) ++at;
    } else if (at < line.size() && line[at] == c) {
      ++at;
    } else {
      return false;
    }
  }
  return true;
}

} // namespace

LinePattern::LinePattern(const std::string& pattern) {
  literals_.emplace_back();
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '{') {
      literals_.back() += pattern[i];
      continue;
    }
    const std::size_t end = pattern.find('}', i);
    if (end == std::string::npos || (!gaps_.empty() && literals_.back().empty()))
      throw InputError(fmt::format("'{}' is no pattern of a line", pattern),
                       end == std::string::npos ? "a brace is not closed" : "nothing stands between two cells",
                       "write it as \"X{x} Y{y}\"");
    gaps_.push_back(pattern.substr(i + 1, end - i - 1));
    if (!gaps_.back().empty()) names_.push_back(gaps_.back());
    literals_.emplace_back();
    i = end;
  }
}

bool LinePattern::match(std::string_view line, std::vector<CsvCell>& cells) const {
  cells.clear();
  std::size_t at = 0;
  while (at < line.size() && blank(line[at])) ++at;
  if (!pass(line, at, literals_.front())) return false;
  for (std::size_t g = 0; g < gaps_.size(); ++g) {
    while (at < line.size() && blank(line[at])) ++at;
    const std::size_t begin = at;
    const std::string& next = literals_[g + 1];
    const std::size_t mark = next.find_first_not_of(" \t");
    const char stop = mark == std::string::npos ? '\0' : next[mark];
    const bool spaced = next.empty() || blank(next.front()); // a blank ends the cell, too
    while (at < line.size() && line[at] != stop && !(spaced && blank(line[at]))) ++at;
    std::size_t end = at;
    while (end > begin && blank(line[end - 1])) --end;
    if (end == begin) return false;
    if (!gaps_[g].empty())
      cells.push_back({std::string(line.substr(begin, end - begin)), 0, static_cast<int>(begin) + 1});
    if (!pass(line, at, next)) return false;
  }
  while (at < line.size() && blank(line[at])) ++at;
  return at == line.size();
}

LogForm::LogForm(const std::string& text, const std::string& file) : file_(file) {
  Problems problems(file);
  const Node document = parse_document(text, file);
  Table top(document, "", problems);
  top.text("title");
  comment_ = top.text("comment").value_or("");
  marks_ = top.text("marks").value_or("");
  bool rows = false;
  for (Table& one : top.tables("lines")) {
    const Node* const node = one.require("pattern", "pattern = \"X{x} Y{y}\"");
    const auto pattern = one.text("pattern");
    const bool row = one.boolean("row").value_or(false);
    rows |= row;
    one.refuse_unknown();
    if (!pattern) continue;
    try {
      lines_.push_back({LinePattern(*pattern), row});
    } catch (const InputError& error) {
      problems.add(*node, one.path("pattern"), error);
      continue;
    }
    for (const std::string& name : lines_.back().pattern.names()) {
      auto known = std::ranges::find(columns_, name);
      if (known == columns_.end()) known = columns_.insert(known, name);
      lines_.back().columns.push_back(static_cast<std::size_t>(known - columns_.begin()));
    }
  }
  if (!rows) top.add("no line makes a row", "the table would be empty", "row = true");
  top.refuse_unknown();
  problems.raise();
}

Csv LogForm::read(std::string_view log, const std::string& file) const {
  Csv out;
  out.file = file;
  for (const std::string& name : columns_) out.header.push_back({name, 1, 1});
  std::vector<CsvCell> kept(columns_.size()), cells;
  std::vector<int> numbers; // of the lines that made the rows
  int number = 0;
  for (std::size_t at = log.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < log.size();) {
    const std::size_t end = std::min(log.find('\n', at), log.size());
    std::string_view line = log.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!comment_.empty() && line.substr(std::min(line.find_first_not_of(" \t"), line.size())).starts_with(comment_))
      continue;
    const auto known = std::ranges::find_if(lines_, [&](const Line& l) { return l.pattern.match(line, cells); });
    if (known == lines_.end()) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i].line = number;
      while (cells[i].text.size() > 1 && marks_.find(cells[i].text.back()) != std::string::npos)
        cells[i].text.pop_back();
      kept[known->columns[i]] = cells[i];
    }
    if (!known->row) continue;
    out.rows.push_back(kept);
    numbers.push_back(number);
  }
  const auto missing = [](const CsvCell& c) { return c.text.empty(); };
  for (std::size_t c = columns_.size(); c-- > 0;) // what no line of this log holds
    if (missing(kept[c])) {
      out.header.erase(out.header.begin() + static_cast<std::ptrdiff_t>(c));
      for (auto& row : out.rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(c));
    }
  std::vector<Problem> problems;
  for (std::size_t r = 0; r < out.rows.size() && problems.size() < most_problems; ++r)
    if (const auto cell = std::ranges::find_if(out.rows[r], missing); cell != out.rows[r].end())
      problems.push_back({{file, numbers[r], 1},
                          fmt::format("the row has no '{}'",
                                      out.header[static_cast<std::size_t>(cell - out.rows[r].begin())].text),
                          fmt::format("no line before it holds one, by {}", file_),
                          "correct the log or its description"});
  if (problems.empty() && out.rows.empty())
    problems.push_back({{file, 0, 0},
                        "no line of the log makes a row",
                        "by " + file_,
                        "compare the log with the patterns of the description"});
  if (!problems.empty()) throw InputError(std::move(problems));
  return out;
}

} // namespace gumshoe::scenario
