#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/math/statistics/bivariate_statistics.hpp>

#include "base/units.h"
#include "scenario/column_words.h"
#include "scenario/recognise.h"

namespace gumshoe::scenario {
namespace {

/// A pressure in the unit of the air's.
bool is_of_the_air(const RecognisedColumn& c) { return c.unit == "hPa" || c.unit == "mbar"; }

/// A length, an angle, a force, a torque, a mass, a pressure that is not the air's, or a number without a unit.
bool is_place(const RecognisedColumn& c) {
  if (c.unit == "?" || c.unit == "1") return true;
  if (is_of_the_air(c)) return false;
  static const std::set<std::string> set_units{
      "m", "rad", units::si_unit_of("N"), units::si_unit_of("N m"), units::si_unit_of("Pa"), "kg"};
  return set_units.contains(units::si_unit_of(c.unit));
}

/// Whether a column numbers all rows in their order.
bool numbers_rows(const RecognisedData& data, const RecognisedColumn& c) {
  if (!c.number || c.gaps || !counts_rows(c)) return false;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const auto value = [&](const auto& row) { return data.csv.number(row[column], data.decimal); };
  return std::ranges::adjacent_find(data.csv.rows, std::greater_equal{}, value) == data.csv.rows.end();
}

/// Whether a column counts 1, 2, 3, ... from row to row, or from another number.
bool rises_by_one(const RecognisedData& data, const RecognisedColumn& c) {
  if (!c.number || c.gaps) return false;
  const auto at = static_cast<std::size_t>(data.csv.find(c.name));
  const auto value = [&](const auto& row) { return data.csv.number(row[at], data.decimal); };
  const auto not_next = [&](const auto& a, const auto& b) { return value(b) != value(a) + 1; };
  return std::ranges::adjacent_find(data.csv.rows, not_next) == data.csv.rows.end();
}

/// Whether the word "set" alone says that it is a position: a column of what was set, or the number of a set.
bool is_position_by_set(const RecognisedColumn& c) {
  return c.role == ColumnRole::position && c.basis == Basis::name && std::ranges::count(words_of(c.name), "set") > 0;
}

/// Whether it is known, by more than that, to be where readings were taken: a place, or a part by its name.
bool is_known_place(const RecognisedColumn& c) {
  if (!c.number && c.role == ColumnRole::other) return true;
  const bool named = c.role == ColumnRole::position && c.basis == Basis::name && !is_position_by_set(c);
  return c.number && is_place(c) && (named || (c.role == ColumnRole::other && c.unit != "?"));
}

/// Whether whole numbers without a unit count stretches of rows, 1 1 1 2 2 2, in each of which a place comes back to
/// the same values: a "set", a "start".
bool numbers_passes(const RecognisedData& data, const RecognisedColumn& c) {
  if (names_parts(c) || is_circumstance(c) || counts_rows(c)) return false;
  if (!c.number || c.gaps || c.unit != "?" || !(is_position_by_set(c) || c.role == ColumnRole::other)) return false;
  const auto at = static_cast<std::size_t>(data.csv.find(c.name));
  std::vector<double> number;
  for (const auto& row : data.csv.rows) number.push_back(data.csv.number(row[at], data.decimal));
  for (std::size_t r = 0; r < number.size(); ++r)
    if (number[r] != std::floor(number[r]) || (r > 0 && number[r] != number[r - 1] && number[r] != number[r - 1] + 1))
      return false;
  return std::ranges::any_of(data.columns, [&](const RecognisedColumn& place) {
    if (&place == &c || !is_known_place(place) || different(data, place) < 2) return false;
    const auto where = static_cast<std::size_t>(data.csv.find(place.name));
    std::map<double, std::set<std::string>> met;
    for (std::size_t r = 0; r < number.size(); ++r) met[number[r]].insert(data.csv.rows[r][where].text);
    return met.size() > 1 && std::ranges::all_of(met, [&](const auto& m) { return m.second == met.begin()->second; });
  });
}

/// Share of a column's variance that a straight line in another explains; 0 of a constant.
double follows(const RecognisedData& data, const RecognisedColumn& column, const RecognisedColumn& other) {
  const auto at = static_cast<std::size_t>(data.csv.find(column.name)),
             by = static_cast<std::size_t>(data.csv.find(other.name));
  std::vector<double> x, y;
  for (const auto& row : data.csv.rows) {
    if (says_missing(row[at].text) || says_missing(row[by].text)) continue;
    x.push_back(data.csv.number(row[by], data.decimal));
    y.push_back(data.csv.number(row[at], data.decimal));
  }
  const double r = x.size() < 3 ? 0 : boost::math::statistics::correlation_coefficient(x, y);
  return r * r > 0 ? r * r : 0; // NaN of a constant
}

constexpr double follows_it = 0.9, does_not = 0.5; ///< such shares

/// Which of several columns of numbers was read, where only its place would tell: the one that follows the position,
/// if no other does, nor the air's pressure.
RecognisedColumn* follower(const RecognisedData& data, const std::vector<RecognisedColumn*>& all) {
  const RecognisedColumn* position = data.find(ColumnRole::position);
  if (!position && !all.empty() && is_place(*all[0]) && was_set(data, *all[0])) position = all[0];
  // In one sweep whatever drifts follows the position.
  if (!position || !position->number || 2 * different(data, *position) > data.csv.rows.size()) return nullptr;
  RecognisedColumn* best = nullptr;
  double most = 0, next = 0;
  for (RecognisedColumn* c : all) {
    const double share = c == position || is_of_the_air(*c) ? 0 : follows(data, *c, *position);
    if (share > most)
      next = std::exchange(most, share), best = c;
    else
      next = std::max(next, share);
  }
  if (!(most > follows_it && next < does_not)) return nullptr;
  // A column in the unit of the position may be the measured position.
  const bool of_one_unit =
      best->unit != "?" && position->unit != "?" && units::convertible(best->unit, units::si_unit_of(position->unit));
  return of_one_unit ? nullptr : best;
}

/// Whether a column that is something else by its name holds what was read: numbers that were not set, and times that
/// do not go on from row to row.
bool was_read(const RecognisedData& data, const RecognisedColumn& c, ColumnRole named) {
  if (!c.number || c.role != named || c.basis != Basis::name || !c.clock.empty() || was_set(data, c)) return false;
  if (named != ColumnRole::time) return true;
  const auto at = static_cast<std::size_t>(data.csv.find(c.name));
  std::vector<double> t;
  for (const auto& row : data.csv.rows)
    if (!says_missing(row[at].text)) t.push_back(data.csv.number(row[at], data.decimal));
  std::size_t falls = 0;
  for (std::size_t i = 1; i < t.size(); ++i) falls += t[i] < t[i - 1];
  return 4 * falls > t.size();
}

} // namespace

void guess_roles(RecognisedData& data) {
  std::vector<RecognisedColumn>& columns = data.columns;
  const auto has = [&](ColumnRole role) {
    return std::ranges::find(columns, role, &RecognisedColumn::role) != columns.end();
  };
  // Numbers but for a cell or two: likelier what was read than a column that was set.
  const auto misprinted = [&](const RecognisedColumn& c) {
    const bool may_be_read = c.role == ColumnRole::reading || (c.role == ColumnRole::other && c.clock.empty());
    std::string rest;
    return may_be_read && !c.number &&
           (cell_with_unit(data, c) || (!unit_in(c.name, rest).empty() && !cells_that_are_no_number(data, c).empty()));
  };
  const auto take = [&](auto first, auto end, ColumnRole role, const char* why) {
    const auto fitting = [&](const RecognisedColumn& c) {
      return c.number && c.role == ColumnRole::other && c.basis != Basis::user && !counts_rows(c) && !names_parts(c) &&
             (role != ColumnRole::position ||
              (is_place(c) && different(data, c) > 1 && was_set(data, c) && !names_levels(data, c)));
    };
    // Numbers that recur and have no unit are names, such as those of inserts; a coordinate that was set is a place.
    const auto likely = [&](const RecognisedColumn& c) {
      return fitting(c) && !is_circumstance(c) &&
             !(role == ColumnRole::reading && (c.unit == "?" || (is_coordinate(c) && is_place(c))) && was_set(data, c));
    };
    if (role == ColumnRole::reading) {
      std::vector<RecognisedColumn*> all;
      for (RecognisedColumn& c : columns)
        if (likely(c)) all.push_back(&c);
      if (RecognisedColumn* const read = follower(data, all)) {
        read->take(role, Basis::place, "as it follows what was set");
        return;
      }
    }
    auto one = std::find_if(first, end, likely);
    if (one == end && role == ColumnRole::reading && std::ranges::any_of(columns, misprinted)) return;
    // A force, a temperature or a time to failure may be what was read, whatever its name.
    if (role == ColumnRole::reading)
      for (const ColumnRole named : {ColumnRole::position, ColumnRole::time, ColumnRole::temperature})
        if (one == end)
          one = std::find_if(first, end, [&](const RecognisedColumn& c) { return was_read(data, c, named); });
    if (one == end) one = std::find_if(first, end, fitting);
    if (one == end) return;
    one->take(role, Basis::place, why);
  };
  // U_mV: a voltage, where nothing else is one that it could be the uncertainty of.
  for (RecognisedColumn& c : columns) {
    if (c.role != ColumnRole::uncertainty || c.unit == "?" || words_of(c.name).front() != "u") continue;
    const auto like = [&](const RecognisedColumn& other) {
      return &other != &c && other.number &&
             (other.unit == "?" || units::convertible(other.unit, units::si_unit_of(c.unit)));
    };
    if (std::ranges::none_of(columns, like)) c.leave();
  }
  if (!has(ColumnRole::cycle))
    for (RecognisedColumn& c : columns)
      if (numbers_passes(data, c)) {
        c.take(ColumnRole::cycle, Basis::cells, "as it numbers passes over the same places");
        c.unit = "1";
        break;
      }
  for (RecognisedColumn& c : columns)
    if (is_position_by_set(c) && c.unit == "?" && (is_circumstance(c) || rises_by_one(data, c)))
      c.leave(); // feed_set; or it counts the readings
  // A pressure next to a target is no second position.
  for (bool known = false; RecognisedColumn & c : columns)
    if (c.role == ColumnRole::position && std::exchange(known, true) && c.basis == Basis::name) c.leave();
  if (!has(ColumnRole::reading))
    take(columns.rbegin(), columns.rend(), ColumnRole::reading, "as the last column of numbers");
  if (!has(ColumnRole::reading) && has(ColumnRole::position) && std::ranges::none_of(columns, misprinted)) {
    // A force may be what was set or what was read.
    const auto last =
        std::ranges::find(columns.rbegin(), columns.rend(), ColumnRole::position, &RecognisedColumn::role);
    last->take(ColumnRole::reading, Basis::place, "as the last column of numbers");
  }
  if (!has(ColumnRole::position))
    take(columns.begin(), columns.end(), ColumnRole::position, "as the first column of numbers");
  if (has(ColumnRole::time)) return;
  const auto count = std::ranges::find_if(columns, [&](const RecognisedColumn& c) { return numbers_rows(data, c); });
  if (count == columns.end()) return;
  count->take(ColumnRole::time, Basis::place, "as it counts the readings");
  count->unit = "1";
}

bool is_circumstance(const RecognisedColumn& c) {
  static const std::set<std::string> names{"feed",    "feedrate",    "vorschub", "speed",     "drehzahl",
                                           "rpm",     "humidity",    "feuchte",  "luftdruck", "barometer",
                                           "ambient", "luftfeuchte", "override", "velocity",  "acceleration"};
  const auto words = words_of(c.name);
  if (std::ranges::any_of(words, [&](const std::string& w) { return names.contains(w); })) return true;
  return c.unit != "?" && std::ranges::any_of(std::array{"1/s", "m/s", "rad/s", "K"},
                                              [&](const char* unit) { return units::convertible(c.unit, unit); });
}

bool counts_rows(const RecognisedColumn& c) {
  static const std::set<std::string> names{"nr", "no", "n", "id", "index", "number", "point", "row", "line"};
  const auto words = words_of(c.name);
  return words.size() == 1 && names.contains(words.front());
}

bool is_coordinate(const RecognisedColumn& c) {
  std::string rest;
  unit_in(c.name, rest);
  const auto words = words_of(rest);
  return words.size() == 1 && words[0].size() == 1 &&
         std::string_view("xyzabcuvw").find(words[0]) != std::string_view::npos;
}

bool names_levels(const RecognisedData& data, const RecognisedColumn& c) {
  constexpr std::size_t most = 6, rows_each = 4;
  if (!c.number || c.gaps || c.unit != "?" || c.role != ColumnRole::other || c.basis == Basis::user ||
      !c.clock.empty() || counts_rows(c) || is_coordinate(c))
    return false;
  const std::size_t n = different(data, c);
  return n > 1 && n <= most && rows_each * n <= data.csv.rows.size();
}

bool names_parts(const RecognisedColumn& c) {
  static const std::set<std::string> names{
      "operator",  "bediener", "observer", "lab",       "laboratory", "batch",      "lot",     "machine",
      "maschine",  "sample",   "part",     "specimen",  "tool",       "artefact",   "probe",   "sensor",
      "day",       "tag",      "shift",    "wafer",     "rod",        "touch",      "hit",     "shot",
      "antastung", "insert",   "cavity",   "nest",      "pose",       "werkzeug",   "teil",    "platte",
      "schneide",  "worker",   "person",   "appraiser", "inspector",  "technician", "analyst", "pruefer",
      "prüfer",    "subject",  "patient",  "site",      "source",     "rail",       "plate",   "station",
      "fixture",   "supplier", "furnace",  "week",      "month",      "woche",      "monat"};
  const auto words = words_of(c.name);
  const bool none = c.unit == "?" || (c.unit == "1" && c.unit_told);
  return none && std::ranges::any_of(words, [&](const std::string& w) { return names.contains(w); });
}

std::vector<const CsvCell*> cells_that_are_no_number(const RecognisedData& data, const RecognisedColumn& c) {
  if (c.number) return {};
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  std::vector<const CsvCell*> odd;
  std::size_t numbers = 0;
  for (const auto& row : data.csv.rows) {
    const CsvCell& cell = row[column];
    if (says_missing(cell.text)) continue;
    if (is_number(data.csv, cell, data.decimal))
      ++numbers;
    else
      odd.push_back(&cell);
  }
  return numbers > odd.size() ? odd : std::vector<const CsvCell*>{};
}

const CsvCell* cell_with_unit(const RecognisedData& data, const RecognisedColumn& c) {
  if (c.number) return nullptr;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const CsvCell* first = nullptr;
  for (const auto& row : data.csv.rows) {
    const CsvCell& cell = row[column];
    if (says_missing(cell.text)) continue;
    const std::size_t end = cell.text.find_first_not_of("+-0123456789.,' eE");
    if (end == std::string::npos || end == 0) return nullptr;
    CsvCell number = cell;
    number.text = cell.text.substr(0, cell.text.find_last_not_of(' ', end - 1) + 1);
    if (number.text.empty() || unit_below(cell.text.substr(end)).empty() || !is_number(data.csv, number, data.decimal))
      return nullptr;
    if (!first) first = &cell;
  }
  return first;
}

CopiedRows copied_rows(const Csv& csv) {
  struct Same { // rows that are equal
    std::size_t times = 0;
    std::vector<std::size_t> at; // the first of them
  };
  constexpr std::size_t most_times = 16;
  constexpr double seldom_equal = 0.1; // files in which so many pairs of rows are equal tell nothing
  std::map<std::vector<std::string_view>, Same> known;
  std::map<std::size_t, std::size_t> before, here; // by an earlier row, which equals this one: as many as precede do
  std::map<std::size_t, std::size_t> by_distance;  // pairs of equal rows
  CopiedRows out;
  std::size_t distance = 0;
  double pairs = 0;
  for (std::size_t r = 0; r < csv.rows.size(); ++r) {
    std::vector<std::string_view> texts;
    for (const CsvCell& cell : csv.rows[r]) texts.emplace_back(cell.text);
    Same& same = known[std::move(texts)];
    pairs += static_cast<double>(same.times++);
    here.clear();
    for (const std::size_t q : same.at) {
      ++by_distance[r - q];
      const auto run = q == 0 ? before.end() : before.find(q - 1);
      const std::size_t rows = here[q] = run == before.end() ? 1 : run->second + 1;
      if (rows <= out.rows || q + rows > r) continue;
      out = {rows, csv.rows[q + 1 - rows].front().line, csv.rows[r + 1 - rows].front().line};
      distance = r - q;
    }
    std::swap(before, here);
    if (same.at.size() < most_times) same.at.push_back(r);
  }
  const double n = static_cast<double>(csv.rows.size());
  if (out.rows == 0 || pairs > seldom_equal * n * (n - 1) / 2) return {};
  // How often rows at one distance are equal by chance, the run itself left out.
  double share = 0;
  for (const auto& [d, equal] : by_distance)
    if (const double all = n - static_cast<double>(d); 4 * all > n)
      share = std::max(share, static_cast<double>(equal + 1 - (d == distance ? out.rows : 0)) / all);
  constexpr double chance = 1e-3; // of such a run anywhere
  return n * n / 2 * std::pow(std::min(share, 1.0), static_cast<double>(out.rows)) < chance ? out : CopiedRows{};
}

std::size_t different(const RecognisedData& data, const RecognisedColumn& c) {
  std::set<std::string> texts;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  for (const auto& row : data.csv.rows) texts.insert(row[column].text);
  return texts.size();
}

bool was_set(const RecognisedData& data, const RecognisedColumn& c) {
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  std::map<std::string, int> texts; // how often each occurs
  std::vector<double> values;
  for (const auto& row : data.csv.rows) {
    if (says_missing(row[column].text)) continue;
    ++texts[row[column].text];
    values.push_back(data.csv.number(row[column], data.decimal));
  }
  const auto in_order = [&](auto before) {
    return std::ranges::adjacent_find(values, std::not_fn(before)) == values.end();
  };
  // A measured number in coarse steps recurs as well, but some of its values come once.
  const auto once = std::ranges::count(texts, 1, [](const auto& text) { return text.second; });
  const bool recur = 2 * texts.size() <= values.size() && 10 * static_cast<std::size_t>(once) <= texts.size();
  return recur || in_order(std::less{}) || in_order(std::greater{});
}

} // namespace gumshoe::scenario
