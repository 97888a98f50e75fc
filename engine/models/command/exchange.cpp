#include "models/command/exchange.h"

#include <charconv>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"

namespace gumshoe::models {
namespace {

template <class Card> void header(std::span<const Card> cards, std::string& text) {
  for (const Card& c : cards) text += fmt::format("{}{} ({})", text.empty() ? "" : ",", c.name, c.unit);
}

std::string_view trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

/// Cells hold numbers and short names: a comma or a line end inside quotes has no meaning here.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    std::string_view cell = trimmed(line.substr(0, comma));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::string_view> lines_of(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    lines.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

/// For messages: bytes of any kind, a few, on one line.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 60)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > 60 ? "..." : "");
}

struct ResultColumn {
  std::size_t at = 0;
  std::string unit;
};

ResultColumn find_column(const VariableCard& measurand, const std::vector<std::string_view>& header,
                         std::string_view line) {
  std::optional<ResultColumn> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    std::string_view name = header[i], unit = measurand.unit;
    if (const auto open = name.find('('); open != std::string_view::npos && name.back() == ')') {
      unit = trimmed(name.substr(open + 1, name.size() - open - 2));
      name = trimmed(name.substr(0, open));
    }
    if (name != measurand.name) continue;
    if (found)
      throw InputError(fmt::format("its output has two columns '{}'", measurand.name),
                       fmt::format("the first line is '{}'", shown(line)), "write each measurand once");
    try {
      units::to_si(1, std::string(unit), std::string(measurand.si_unit));
    } catch (const InputError& error) {
      const Problem& p = error.problems().front();
      throw InputError(fmt::format("its column {}: {}", measurand.name, p.what), p.why, p.remedy);
    }
    found = ResultColumn{i, std::string(unit)};
  }
  if (found) return *found;
  throw InputError(fmt::format("its output has no column '{}'", measurand.name),
                   fmt::format("the first line is '{}'", shown(line)),
                   fmt::format("write a header with {} ({})", measurand.name, measurand.unit));
}

double number_in(std::string_view cell) {
  double value = 0;
  if (cell.size() > 1 && cell.front() == '+' && cell[1] != '-') cell.remove_prefix(1);
  const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && stop == cell.data() + cell.size() ? value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

std::string points_table(const ModelCard& card, const ShownReading& reading, std::size_t first, std::size_t n) {
  std::string text;
  header(card.quantities, text);
  header(card.conditions, text);
  header(card.indications, text);
  text += '\n';
  std::vector<Column> columns = reading.quantities;
  columns.insert(columns.end(), reading.conditions.begin(), reading.conditions.end());
  columns.insert(columns.end(), reading.indications.begin(), reading.indications.end());
  text.reserve(text.size() + n * columns.size() * 25);
  for (std::size_t i = first; i < first + n; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      fmt::format_to(std::back_inserter(text), "{}{:.17g}", c == 0 ? "" : ",", columns[c].data[i * columns[c].stride]);
    text += '\n';
  }
  return text;
}

void read_results(const ModelCard& card, const std::string& text, std::size_t n, double* const* measurands,
                  std::uint8_t* status) {
  const auto lines = lines_of(text);
  std::size_t at = 0;
  while (at < lines.size() && lines[at].empty()) ++at;
  if (at == lines.size()) throw InputError("it wrote nothing", "", "write a header and one row per point to stdout");
  const std::string_view head = lines[at++];
  const auto names = cells_of(head);
  std::vector<ResultColumn> columns;
  for (const VariableCard& m : card.measurands) columns.push_back(find_column(m, names, head));
  std::size_t row = 0, surplus = 0;
  for (; at < lines.size(); ++at) {
    const bool blank = lines[at].empty();
    if (blank && (names.size() > 1 || row == n)) continue; // with one column a blank line is an empty cell
    if (row == n) {
      ++surplus;
      continue;
    }
    const auto cells = cells_of(lines[at]);
    if (cells.size() != names.size())
      throw InputError(
          fmt::format("line {} of its output has {} cells, but the header has {}", at + 1, cells.size(), names.size()),
          fmt::format("it is '{}'", shown(lines[at])));
    for (std::size_t m = 0; m < columns.size(); ++m) measurands[m][row] = number_in(cells[columns[m].at]);
    ++row;
  }
  if (row < n || surplus > 0)
    throw InputError(fmt::format("it wrote {} rows for {} points", row + surplus, n), "",
                     "write one row per point, in the order of the points");
  for (std::size_t m = 0; m < columns.size(); ++m) {
    VariableCard as_written = card.measurands[m];
    as_written.unit = columns[m].unit;
    take_shown(as_written, measurands[m], n, status);
  }
}

} // namespace gumshoe::models
