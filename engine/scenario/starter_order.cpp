#include "scenario/starter_order.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <string_view>

#include "base/clock.h"

namespace gumshoe::scenario {
namespace {

std::size_t place(const RecognisedData& data, const RecognisedColumn& c) {
  return static_cast<std::size_t>(data.csv.find(c.name));
}

/// Numbers of a column by row; empty if a cell has none.
std::vector<double> numbers_of(const RecognisedData& data, const RecognisedColumn& c) {
  std::vector<double> out;
  if (!c.number || c.gaps || !c.clock.empty()) return out;
  for (const auto& row : data.csv.rows) out.push_back(data.csv.number(row[place(data, c)], data.decimal));
  return out;
}

} // namespace

bool counts_blocks(const RecognisedColumn& c) {
  constexpr std::array<std::string_view, 8> days{"day", "tag", "shift", "schicht", "week", "woche", "month", "monat"};
  if (c.role == ColumnRole::cycle) return true;
  if (!names_parts(c)) return false;
  const auto words = words_of(c.name);
  return std::ranges::any_of(words, [&](const std::string& w) { return std::ranges::find(days, w) != days.end(); });
}

std::vector<const RecognisedColumn*> restarted_by(const RecognisedData& data, const RecognisedColumn& time) {
  const std::vector<double> t = numbers_of(data, time);
  std::vector<const RecognisedColumn*> blocks;
  for (const RecognisedColumn& c : data.columns)
    if (&c != &time && counts_blocks(c) && different(data, c) > 1) blocks.push_back(&c);
  std::vector<bool> at(blocks.size(), false); // changes where the time goes back
  const auto text_at = [&](std::size_t row, const RecognisedColumn& c) -> const std::string& {
    return data.csv.rows[row][place(data, c)].text;
  };
  std::size_t changes = 0, back = 0;
  for (std::size_t r = 1; r < t.size(); ++r) {
    const bool falls = t[r] < t[r - 1];
    bool changed = false;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (text_at(r, *blocks[b]) != text_at(r - 1, *blocks[b])) {
        changed = true;
        if (falls) at[b] = true;
      }
    if (falls && !changed) return {};
    changes += changed;
    back += falls;
  }
  // Times that go back once are those of a clock that was set.
  constexpr std::size_t rows_of_a_block = 3;
  if (2 * back <= changes || back == 0 || rows_of_a_block * (changes + 1) > t.size()) return {};
  for (std::size_t b = blocks.size(); b-- > 0;)
    if (!at[b]) blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(b));
  return blocks;
}

std::vector<const RecognisedColumn*> numbered_blocks(const RecognisedData& data) {
  constexpr std::size_t least = 4;
  std::vector<const RecognisedColumn*> out;
  for (const RecognisedColumn& c : data.columns) {
    if (!counts_blocks(c) || different(data, c) < least) continue;
    const std::vector<double> number = numbers_of(data, c);
    if (!number.empty() && std::ranges::is_sorted(number)) out.push_back(&c);
  }
  return out;
}

std::vector<const RecognisedColumn*> days_in_order(const RecognisedData& data) {
  constexpr std::size_t least = 3;
  std::vector<const RecognisedColumn*> out;
  for (const RecognisedColumn& c : data.columns) {
    if (c.role != ColumnRole::cycle || c.clock.empty() || different(data, c) < least) continue;
    const ClockFormat form(c.clock);
    std::vector<Moment> days;
    for (const auto& row : data.csv.rows)
      if (const std::optional<Moment> day = form.parse(row[place(data, c)].text)) days.push_back(*day);
    const auto before = [](const Moment& a, const Moment& b) { return a.since(b) < 0; };
    if (days.size() == data.csv.rows.size() && std::ranges::is_sorted(days, before)) out.push_back(&c);
  }
  return out;
}

namespace {

/// The column of a position, or where there is none of a temperature, whose numbers only rise or only fall; null: none.
const RecognisedColumn* sweep(const RecognisedData& data) {
  constexpr std::size_t least = 5; // of fewer levels a stretch holds several
  const auto is = [](ColumnRole role) { return [role](const RecognisedColumn& c) { return c.role == role; }; };
  const bool placed = std::ranges::any_of(data.columns, is(ColumnRole::position)); // else a temperature was set
  for (const RecognisedColumn& c : data.columns) {
    if (c.role != (placed ? ColumnRole::position : ColumnRole::temperature) || different(data, c) < least) continue;
    const std::vector<double> number = numbers_of(data, c);
    if (!number.empty() && (std::ranges::is_sorted(number) || std::ranges::is_sorted(number, std::greater{})))
      return &c;
  }
  return nullptr;
}

/// Number of stretches of rows that agree in some columns; 0 if such rows come back after others.
std::size_t stretches(const RecognisedData& data, const std::vector<const RecognisedColumn*>& columns) {
  std::set<std::vector<std::string_view>> met;
  std::vector<std::string_view> here;
  for (const auto& row : data.csv.rows) {
    std::vector<std::string_view> key;
    for (const RecognisedColumn* c : columns) key.push_back(row[place(data, *c)].text);
    if (!met.empty() && key == here) continue;
    if (!met.insert(key).second) return 0;
    here = std::move(key);
  }
  return met.size();
}

/// The labels of a table of a study, the slowest first; empty: it is none.
std::vector<const RecognisedColumn*> sorted_labels(const RecognisedData& data,
                                                   std::vector<const RecognisedColumn*> labels) {
  std::erase_if(labels, [&](const RecognisedColumn* c) { return different(data, *c) < 2; });
  const auto changes = [&](const RecognisedColumn* c) {
    const auto differ = [&](const auto& a, const auto& b) {
      return a[place(data, *c)].text != b[place(data, *c)].text;
    };
    std::size_t n = 0;
    for (std::size_t r = 1; r < data.csv.rows.size(); ++r) n += differ(data.csv.rows[r - 1], data.csv.rows[r]);
    return n;
  };
  std::ranges::stable_sort(labels, {}, changes);
  std::vector<const RecognisedColumn*> out;
  std::size_t crossed = 1; // groups, if each word met each word of the others
  for (const RecognisedColumn* c : labels) {
    out.push_back(c);
    crossed *= different(data, *c);
    const std::size_t groups = stretches(data, out);
    // Groups of one reading each tell nothing: operators may measure one part after the other. Parts of their own in
    // each batch are drawn from many, as batches are: whether they scatter is seen on whole batches that are left out.
    if (groups > 0 && 2 * groups <= data.csv.rows.size() && 3 * groups >= 2 * crossed) continue;
    out.pop_back();
    break;
  }
  // What is measured in cycles or on days follows in time.
  return out.size() < 2 || counts_blocks(*out.front()) ? std::vector<const RecognisedColumn*>{} : out;
}

} // namespace

std::vector<const RecognisedColumn*> sorted_by(const RecognisedData& data,
                                               const std::vector<const RecognisedColumn*>& labels) {
  const RecognisedColumn* const time = data.find(ColumnRole::time);
  if (time && time->basis != Basis::place) return {};
  // Numbers of rows may be the order of measurement, or that of the table: then it need not be forgotten.
  const RecognisedColumn* const swept = time ? nullptr : sweep(data);
  return swept ? std::vector{swept} : sorted_labels(data, labels);
}

} // namespace gumshoe::scenario
