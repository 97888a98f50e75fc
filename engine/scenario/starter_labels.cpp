/// Columns that tell readings apart, and why others do not.
#include <algorithm>

#include <fmt/format.h>

#include "scenario/starter_order.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {

namespace {

/// Whether two columns divide the rows alike, as the number of a point and its position.
bool divide_alike(const RecognisedData& data, const RecognisedColumn& a, const RecognisedColumn& b) {
  std::set<std::pair<std::string_view, std::string_view>> pairs;
  for (const auto& row : data.csv.rows)
    pairs.emplace(row[static_cast<std::size_t>(data.csv.find(a.name))].text,
                  row[static_cast<std::size_t>(data.csv.find(b.name))].text);
  return pairs.size() == different(data, a) && pairs.size() == different(data, b);
}

/// Whether the words or the role of a column tell readings apart.
bool tells_apart(const RecognisedData& data, const RecognisedColumn& c) {
  const std::size_t n = different(data, c);
  if (c.role == ColumnRole::cycle || c.role == ColumnRole::alignment) return n > 1;
  if (c.role == ColumnRole::label || names_levels(data, c)) return true;
  return c.role == ColumnRole::other && (!c.number || names_parts(c)) && c.clock.empty() && c.words.empty() && n > 1 &&
         2 * n <= data.csv.rows.size();
}

/// Number of rows with a reading in which the column is empty.
std::size_t empty_cells(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const RecognisedColumn* const reading = data.find(ColumnRole::reading);
  return static_cast<std::size_t>(std::ranges::count_if(data.csv.rows, [&](const auto& row) {
    return row[column].text.empty() &&
           !(reading && says_missing(row[static_cast<std::size_t>(data.csv.find(reading->name))].text));
  }));
}

/// Whether so many rows have no text in the column that it may be one of remarks.
bool mostly_empty(const RecognisedData& data, const RecognisedColumn& c) {
  return 10 * empty_cells(data, c) > data.csv.rows.size();
}

} // namespace

bool comes_back(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  std::set<std::string> left;
  std::string here;
  for (const auto& row : data.csv.rows) {
    const std::string& text = row[column].text;
    if (text == here) continue;
    if (left.contains(text)) return true;
    left.insert(here);
    here = text;
  }
  return false;
}

const NamedColumns::value_type* block_label(const RecognisedData& data, const NamedColumns& labels) {
  for (const bool cycle : {true, false}) // what counts cycles, before other words that recur
    for (const auto& label : labels) {
      const RecognisedColumn& c = *label.second;
      if ((c.role == ColumnRole::cycle || c.role == ColumnRole::alignment) == cycle && different(data, c) >= 4 &&
          (cycle || !comes_back(data, c)))
        return &label;
    }
  return nullptr;
}

namespace {

/// "line 5", or with several files "b.csv, line 5".
std::string line_of(const Csv& csv, const CsvCell& cell) {
  return fmt::format("{}line {}", csv.parts.empty() ? "" : csv.at(cell).file + ", ", cell.line);
}

/// The cells that keep a column from being one of numbers, in words; empty if there are none.
std::string odd_cells(const RecognisedData& data, const RecognisedColumn& c) {
  const std::vector<const CsvCell*> odd = cells_that_are_no_number(data, c);
  if (odd.empty()) return {};
  std::string out = fmt::format("'{}' in {} is not a number", odd[0]->text, line_of(data.csv, *odd[0]));
  if (odd.size() > 1) out += fmt::format(", nor are {} more of its cells", odd.size() - 1);
  return out;
}

/// Why a column of uncertainties is none.
std::string not_above_zero(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const auto bad = std::ranges::find_if(data.csv.rows, [&](const auto& row) {
    return !says_missing(row[column].text) && !(data.csv.number(row[column], data.decimal) > 0);
  });
  return bad == data.csv.rows.end() ? "it is not above 0 in every row"
                                    : fmt::format("it is not above 0 in every row: '{}' in {}", (*bad)[column].text,
                                                  line_of(data.csv, (*bad)[column]));
}

/// Whether a column has numbers of a unit, but for misprints: it tells nothing apart. Runs 1, 2 and 2b do.
bool is_misprinted(const RecognisedData& data, const RecognisedColumn& c) {
  std::string rest;
  const bool has_unit = (c.unit != "1" && c.unit != "?") || !unit_in(c.name, rest).empty();
  return has_unit && !odd_cells(data, c).empty();
}

} // namespace

bool has_empty_cells(const RecognisedData& data, const RecognisedColumn& label) { return empty_cells(data, label) > 0; }

namespace {

/// The column before it, or one with a role, that divides the rows alike and shares a word of its name, as part and
/// part_id do, or of numbers the position; null: there is none. An operator with a machine of his own is no other name.
const RecognisedColumn* other_name_of(const RecognisedData& data, const RecognisedColumn& c) {
  if (c.role != ColumnRole::other) return nullptr;
  const auto words = words_of(c.name);
  const auto shares_a_word = [&](const RecognisedColumn& other) {
    return std::ranges::any_of(words_of(other.name),
                               [&](const std::string& w) { return std::ranges::find(words, w) != words.end(); });
  };
  const auto is = [&](const RecognisedColumn& other) {
    if (&other == &c || !(shares_a_word(other) || (c.number && other.role == ColumnRole::position))) return false;
    const bool known = other.role == ColumnRole::position || other.role == ColumnRole::cycle ||
                       other.role == ColumnRole::alignment || other.role == ColumnRole::label ||
                       (&other < &c && tells_apart(data, other));
    return known && divide_alike(data, c, other);
  };
  const auto one = std::ranges::find_if(data.columns, is);
  return one == data.columns.end() ? nullptr : &*one;
}

} // namespace

NamedColumns labels_of(const RecognisedData& data, const std::set<std::string>& used) {
  NamedColumns out;
  for (const RecognisedColumn& c : data.columns)
    if (tells_apart(data, c) && !mostly_empty(data, c) && !is_misprinted(data, c) && !other_name_of(data, c) &&
        !(used.contains(c.name) && names_levels(data, c)))
      out.emplace_back("", &c);
  Names names{"reading", "row"};                       // labels that mean something else in a scenario
  if (!block_label(data, out)) names.reserve("block"); // stretches
  for (auto& [name, c] : out) name = names.add(c->name);
  return out;
}

const RecognisedColumn* uncertainty_of(const RecognisedData& data) {
  const RecognisedColumn* const sd = data.find(ColumnRole::uncertainty);
  if (!sd || !sd->number) return nullptr;
  const auto column = static_cast<std::size_t>(data.csv.find(sd->name));
  const bool above_zero = std::ranges::all_of(data.csv.rows, [&](const auto& row) {
    return says_missing(row[column].text) || data.csv.number(row[column], data.decimal) > 0;
  });
  return above_zero ? sd : nullptr;
}

std::string why_not_used(const RecognisedData& data, const RecognisedColumn& c) {
  const bool never_changes = data.csv.rows.size() > 1 && different(data, c) == 1;
  if (never_changes && (c.role == ColumnRole::cycle || c.role == ColumnRole::alignment || c.why.empty()))
    return "it is the same in every row";
  if (tells_apart(data, c) && mostly_empty(data, c))
    return "it is empty in more than a tenth of the rows, and a label is in none";
  if (const RecognisedColumn* const other = tells_apart(data, c) ? other_name_of(data, c) : nullptr)
    return fmt::format("it divides the rows as {} does", other->name);
  const RecognisedColumn* const first = data.find(c.role);
  if (c.role == ColumnRole::time && first && first != &c && first->date != c.name) return "the time is " + first->name;
  if (c.role == ColumnRole::uncertainty && first == &c && !uncertainty_of(data))
    if (c.number) return not_above_zero(data, c);
  if (const CsvCell* const cell = cell_with_unit(data, c))
    return fmt::format("its cells hold their unit, as '{}': write numbers alone, and the unit in the column's name",
                       cell->text);
  if (std::string odd = odd_cells(data, c); !odd.empty() && c.words.empty()) return odd;
  if (!c.number && c.words.empty() &&
      (c.role == ColumnRole::temperature || c.role == ColumnRole::direction || c.role == ColumnRole::uncertainty))
    return "not all of its cells are numbers";
  return c.why;
}

} // namespace gumshoe::scenario
