#include "base/csv.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/text_file.h"

namespace gumshoe {
namespace {

constexpr std::size_t most_told = 20;

/// Blanks, tabs and no-break spaces (U+00A0, U+202F), which spreadsheets put around numbers.
constexpr std::string_view spaces[] = {" ", "\t", "\xC2\xA0", "\xE2\x80\xAF"};

std::string trimmed(std::string_view text) {
  for (bool more = true; std::exchange(more, false);)
    for (const std::string_view space : spaces) {
      if (text.starts_with(space)) text.remove_prefix(space.size()), more = true;
      if (text.ends_with(space)) text.remove_suffix(space.size()), more = true;
    }
  return std::string(text);
}

/// Reads the text once, row by row.
class Reader {
public:
  Reader(std::string_view text, const std::string& file, char separator)
      : text_(text), file_(file), separator_(separator) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    take_stated_separator();
  }

  bool next(std::vector<CsvCell>& row) {
    row.clear();
    while (at_ < text_.size()) {
      const std::size_t begin = std::min(text_.find_first_not_of(" \t", at_), text_.size());
      if (begin < text_.size() && text_[begin] == '#') {
        comment(begin + 1);
        continue;
      }
      if (separator_ == '\0') find_separator();
      bool more = true;
      while (more) more = cell(row);
      const auto blank = [](const CsvCell& c) { return c.text.empty() && !c.quoted; };
      if (std::ranges::all_of(row, blank)) { // a blank line, or one of separators
        row.clear();
        continue;
      }
      if (cells_ == 0) cells_ = row.size();
      return true;
    }
    return false;
  }

  int comments_like_rows() const { return comments_like_rows_; }
  char separator() const { return separator_; } ///< '\0' before the header is read

  /// Passes over the lines before this one.
  void skip_to(int line) {
    while (line_ < line && at_ < text_.size()) {
      at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      end_line();
    }
  }

private:
  void comment(std::size_t begin) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
    std::size_t cells = 0, numbers = 0;
    for (std::size_t from = begin; cells_ > 0 && from <= end; ++cells) {
      const std::size_t to = std::min(text_.find(separator_, from), end);
      const std::string text = trimmed(text_.substr(from, to - from));
      double unused = 0;
      const char* const last = text.data() + text.size();
      numbers += !text.empty() && std::from_chars(text.data(), last, unused).ptr == last;
      from = to + 1;
    }
    comments_like_rows_ += cells > 0 && cells == cells_ && numbers > 0;
    at_ = end;
    end_line();
  }

  void end_line() {
    if (at_ < text_.size() && text_[at_++] == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
    new_line();
  }

  /// A first line `sep=;` is a spreadsheet's and says what separates the cells.
  void take_stated_separator() {
    constexpr std::string_view key = "sep=";
    const auto is_end = [&](std::size_t at) { return at == text_.size() || text_[at] == '\n' || text_[at] == '\r'; };
    if (text_.size() <= key.size() || !is_end(key.size() + 1) || is_end(key.size())) return;
    const auto alike = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    if (!std::ranges::equal(text_.substr(0, key.size()), key, alike)) return;
    if (separator_ == '\0') separator_ = text_[key.size()];
    at_ = key.size() + 1;
    end_line();
  }

  /// From the header: a comma outside quotes, otherwise a semicolon or a tab.
  void find_separator() {
    bool quoted = false;
    for (std::size_t i = at_; i < text_.size() && (quoted || (text_[i] != '\n' && text_[i] != '\r')); ++i) {
      const char c = text_[i];
      if (c == '"') quoted = !quoted;
      if (quoted) continue;
      if (c == ',' || c == ';' || (c == '\t' && separator_ == '\0')) separator_ = c;
      if (c == ',') return;
    }
    if (separator_ == '\0') separator_ = ',';
  }

  /// Reads one cell; true if another one follows on the same row.
  bool cell(std::vector<CsvCell>& row) {
    CsvCell cell{{}, line_, static_cast<int>(at_ - line_start_) + 1};
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_, ++cell.column;
    if (at_ < text_.size() && text_[at_] == '"') {
      quoted(cell);
      cell.quoted = true;
      const std::size_t after = at_;
      while (at_ < text_.size() && !ends_cell(text_[at_])) ++at_;
      if (!trimmed(text_.substr(after, at_ - after)).empty())
        throw InputError({{{file_, cell.line, cell.column}, "text follows a closing quote", "", ""}});
    } else {
      const std::size_t begin = at_;
      while (at_ < text_.size() && !ends_cell(text_[at_])) ++at_;
      cell.text = trimmed(text_.substr(begin, at_ - begin));
    }
    row.push_back(std::move(cell));
    if (separator_ == ' ') // any number of them separates, and none follows the last cell
      while (at_ < text_.size() && is_blank(text_[at_]) && at_ + 1 < text_.size() && ends_cell(text_[at_ + 1])) ++at_;
    if (at_ >= text_.size()) return false;
    const char end = text_[at_++];
    if (end != '\n' && end != '\r') return separator_ != ' ' || at_ < text_.size();
    if (end == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
    new_line();
    return false;
  }

  void quoted(CsvCell& cell) {
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') {
          ++at_;
          return;
        }
        ++at_;
      }
      cell.text += text_[at_];
      if (text_[at_] == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      }
    }
    throw InputError({{{file_, cell.line, cell.column}, "a quote is not closed", "", ""}});
  }

  bool ends_cell(char c) const { return c == separator_ || c == '\n' || c == '\r' || (separator_ == ' ' && c == '\t'); }
  /// Blank within a row, around a cell.
  bool is_blank(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }
  void new_line() {
    ++line_;
    line_start_ = at_;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0, line_start_ = 0, cells_ = 0; ///< cells of the header
  int line_ = 1, comments_like_rows_ = 0;
  char separator_; ///< '\0' until the header is read
};

} // namespace

int Csv::find(std::string_view name) const {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (header[i].text == name) return static_cast<int>(i);
  return -1;
}

std::vector<std::string> Csv::names() const {
  std::vector<std::string> out;
  for (const CsvCell& cell : header) out.push_back(cell.text);
  return out;
}

namespace {

/// "1.234.567,89" and "1'234.5" without the signs between thousands. It stays as it stands where they are not
/// unmistakable: "1.234" may be meant to be a thousand times smaller.
std::string without_thousands(const std::string& text, char decimal) {
  const std::size_t point = text.find(decimal), begin = text.find_first_not_of("+- ");
  const std::size_t first = text.find_first_of(decimal == ',' ? ".'" : ",'");
  if (point == std::string::npos || first >= point || first <= begin || first - begin > 3 || (point - first) % 4 != 0 ||
      text[begin] == '0')
    return text;
  std::string out = text.substr(0, first);
  for (std::size_t at = first; at < point; at += 4) {
    if (text[at] != text[first]) return text;
    out += text.substr(at + 1, 3);
  }
  return out + text.substr(point);
}

} // namespace

double Csv::number(const CsvCell& cell, char decimal) const {
  std::string text = without_thousands(trimmed(cell.text), decimal);
  const bool points = text.find('.') != std::string::npos, comma = std::count(text.begin(), text.end(), ',') == 1;
  if (comma) std::replace(text.begin(), text.end(), ',', '.');
  double value = 0;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (text.size() > 1 && *begin == '+' && begin[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  const bool is_number = error == std::errc() && stop == end && std::isfinite(value);
  if (is_number && (decimal == ',' ? !points : !comma)) return value;
  const bool other_sign = is_number && points != comma;
  throw InputError({{at(cell), fmt::format("'{}' is not a number", cell.text),
                     other_sign ? fmt::format("the decimal sign must be a {}", decimal == ',' ? "comma" : "point") : "",
                     other_sign ? fmt::format("decimal = \"{}\"", decimal == ',' ? '.' : ',') : ""}});
}

namespace {

/// A last column that has neither a name nor a text: each line ends with a separator.
void drop_empty_column(Csv& csv) {
  const std::size_t last = csv.header.size() - 1;
  if (last == 0 || !csv.header.back().text.empty()) return;
  for (const auto& row : csv.rows)
    if (!row[last].text.empty()) return;
  csv.header.pop_back();
  for (auto& row : csv.rows) row.pop_back();
}

/// Whether a row would have as many cells as the header, if some of its commas stood within numbers.
bool has_decimal_commas(const std::vector<CsvCell>& row, std::size_t cells) {
  const auto digits = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const auto whole = [&](std::string_view text) {
    return digits(text.substr(std::min(text.find_first_not_of("+-"), text.size())));
  };
  std::size_t joined = 0;
  for (std::size_t i = 0; i + 1 < row.size(); ++i)
    if (whole(row[i].text) && digits(row[i + 1].text)) ++joined, ++i;
  return row.size() > cells && row.size() - cells <= joined;
}

} // namespace

Csv parse_csv(std::string_view text, const std::string& file, const CsvLayout& layout) {
  Csv csv;
  csv.file = file;
  Reader reader(text, csv.file, layout.separator);
  std::vector<Problem> problems;
  reader.skip_to(layout.header);
  if (!reader.next(csv.header)) throw InputError({{{file, 0, 0}, "the file is empty", "", "write a header and rows"}});
  reader.skip_to(layout.rows);
  const int below = layout.rows > 0 ? layout.rows - csv.header.front().line : 1;
  for (std::vector<CsvCell> row; problems.size() < most_told && reader.next(row);) {
    // A control that goes on with a log writes its head again.
    if (csv.header.size() > 1 && std::ranges::equal(row, csv.header, {}, &CsvCell::text, &CsvCell::text)) {
      reader.skip_to(row.front().line + below);
      continue;
    }
    // A logger may end its rows with a separator, and not its header.
    if (row.size() == csv.header.size() + 1 && row.back().text.empty() && !row.back().quoted) row.pop_back();
    if (row.size() != csv.header.size()) {
      const bool commas = csv.rows.empty() && problems.empty() && reader.separator() == ',' &&
                          has_decimal_commas(row, csv.header.size());
      problems.push_back(
          {csv.at(row.front()), fmt::format("the row has {} cells, the header {}", row.size(), csv.header.size()),
           commas ? "a comma separates cells" : "",
           commas ? "is the comma the decimal sign? Then write semicolons between the cells, and decimal "
                    "= \",\" in the scenario (evaluate: --decimal \",\")"
                  : ""});
    } else {
      csv.rows.push_back(std::move(row));
    }
  }
  drop_empty_column(csv);
  std::set<std::string_view> names; // a line that is no header may have hundreds of thousands
  for (const CsvCell& cell : csv.header) {
    if (problems.size() >= most_told) break;
    if (cell.text.empty())
      problems.push_back({csv.at(cell), "a column has no name", "", ""});
    else if (!names.insert(cell.text).second)
      problems.push_back({csv.at(cell), fmt::format("column '{}' appears twice", cell.text), "", ""});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  csv.comments_like_rows = reader.comments_like_rows();
  return csv;
}

Csv join_csv(std::vector<Csv> parts, const std::string& name,
             const std::vector<std::pair<std::string, std::vector<std::string>>>& added) {
  Csv out;
  out.file = name;
  std::vector<Problem> problems;
  for (const auto& column : added) out.header.push_back({column.first, 1, 1});
  for (const CsvCell& cell : parts.front().header) {
    if (std::ranges::any_of(added, [&](const auto& a) { return a.first == cell.text; }))
      problems.push_back({parts.front().at(cell), fmt::format("the file has a column '{}' itself", cell.text),
                          "the name of the file gives this column", "use another name in the braces"});
    out.header.push_back(cell);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Csv& part = parts[p];
    out.parts.push_back(part.file);
    out.comments_like_rows += part.comments_like_rows;
    std::vector<std::size_t> from;
    for (const CsvCell& cell : parts.front().header) {
      const int column = part.find(cell.text);
      if (column < 0)
        problems.push_back({part.at(part.header.front()), fmt::format("there is no column '{}'", cell.text),
                            "files that are read as one have the columns of the first, " + parts.front().file, ""});
      from.push_back(static_cast<std::size_t>(std::max(column, 0)));
    }
    for (auto& row : part.rows) {
      std::vector<CsvCell> cells;
      for (const auto& column : added) cells.push_back({column.second[p], row.front().line, 1});
      for (const std::size_t column : from) cells.push_back(row[column]);
      for (CsvCell& cell : cells) cell.part = static_cast<int>(p);
      out.rows.push_back(std::move(cells));
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return out;
}

std::string csv_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string csv_cell(const std::string& text, char separator) {
  const bool plain = text.find(separator) == std::string::npos && text.find_first_of("\"\n\r") == std::string::npos;
  return plain ? text : csv_quoted(text);
}

Csv read_csv(const std::string& path, std::size_t limit) { return parse_csv(read_data_file(path, limit), path); }

} // namespace gumshoe
