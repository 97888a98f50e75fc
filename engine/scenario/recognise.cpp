#include "scenario/recognise.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/units.h"

namespace gumshoe::scenario {
namespace {

struct RoleWords {
  ColumnRole role;
  std::vector<std::string_view> words;
};
/// In the order in which they count: "position error" is a reading.
const std::vector<RoleWords>& role_words() {
  static const std::vector<RoleWords> all{
      {ColumnRole::uncertainty, {"sd", "std", "sigma", "u", "uncertainty", "unsicherheit"}},
      {ColumnRole::temperature, {"temp", "temperature", "temperatur"}},
      {ColumnRole::direction, {"dir", "direction", "richtung", "approach", "sense"}},
      {ColumnRole::cycle, {"cycle",   "run",     "repeat", "repetition", "pass",    "lauf",      "zyklus",
                           "setup",   "series",  "reihe",  "messreihe",  "serie",   "durchgang", "trial",
                           "round",   "runde",   "expt",   "experiment", "versuch", "replicate", "rep",
                           "session", "sitzung", "visit",  "campaign",   "sweep",   "lap",       "umlauf"}},
      {ColumnRole::time,
       {"time", "zeit", "timestamp", "datetime", "date", "datum", "clock", "uhrzeit", "t", "elapsed", "seconds",
        "sekunden", "minutes", "minuten", "hours", "stunden"}},
      {ColumnRole::reading,
       {"dev",      "deviation", "error",      "err",     "abweichung", "reading",    "laser",  "measured",
        "meas",     "actual",    "act",        "ist",     "diff",       "difference", "result", "value",
        "messwert", "wert",      "indication", "anzeige", "signal",     "output"}},
      {ColumnRole::position,
       {"pos", "position", "target", "tgt", "nominal", "nom", "soll", "set", "setpoint", "command", "commanded", "load",
        "last", "force", "kraft", "pressure", "druck", "angle", "winkel"}},
  };
  return all;
}

/// Spellings of units in headers.
const std::map<std::string, std::string>& unit_words() {
  static const std::map<std::string, std::string> all{
      {"um", "um"},         {"µm", "um"},         {"μm", "um"},     {"micron", "um"},   {"nm", "nm"},
      {"mm", "mm"},         {"m", "m"},           {"km", "km"},     {"inch", "inch"},   {"deg", "deg"},
      {"°", "deg"},         {"rad", "rad"},       {"mrad", "mrad"}, {"urad", "urad"},   {"µrad", "urad"},
      {"arcsec", "arcsec"}, {"s", "s"},           {"sec", "s"},     {"ms", "ms"},       {"min", "min"},
      {"h", "h"},           {"K", "K"},           {"degC", "degC"}, {"°C", "degC"},     {"C", "degC"},
      {"N", "N"},           {"mm/min", "mm/min"}, {"mm/s", "mm/s"}, {"um/m", "um/m"},   {"%", "%"},
      {"ppm", "ppm"},       {"ppb", "ppb"},       {"Hz", "Hz"},     {"kN", "kN"},       {"MN", "MN"},
      {"Nm", "N m"},        {"V", "V"},           {"mV", "mV"},     {"mV/V", "mV/V"},   {"mVV", "mV/V"},
      {"bar", "bar"},       {"mbar", "mbar"},     {"Pa", "Pa"},     {"hPa", "hPa"},     {"kPa", "kPa"},
      {"MPa", "MPa"},       {"kg", "kg"},         {"rpm", "1/min"}, {"1/min", "1/min"}, {"U/min", "1/min"},
      {"m/min", "m/min"}};
  return all;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The unit of a time that is named after it: "minutes"; empty of any other name.
std::string unit_of_time(const std::vector<std::string>& words) {
  static const std::map<std::string, std::string> all{{"seconds", "s"},   {"sekunden", "s"}, {"minutes", "min"},
                                                      {"minuten", "min"}, {"hours", "h"},    {"stunden", "h"}};
  for (const std::string& word : words)
    if (const auto known = all.find(word); known != all.end()) return known->second;
  return "";
}

/// "mm" and "min": mm/min, a speed or any other ratio that has a name; empty if they are no such pair.
std::string ratio(const std::string& above, const std::string& below) {
  if (const auto both = unit_words().find(above + "/" + below); both != unit_words().end()) return both->second;
  const auto upper = unit_words().find(above), lower = unit_words().find(below);
  if (upper == unit_words().end() || lower == unit_words().end()) return "";
  const std::string si_unit = units::si_unit_of(upper->second);
  const bool speed = (si_unit == "m" || si_unit == "rad") && units::si_unit_of(lower->second) == "s";
  return speed ? upper->second + "/" + lower->second : "";
}

/// "pos (mm)", "pos [mm]", "pos_mm", "pos/mm", "pos mm": the unit, or empty; `rest` is the name without it.
std::string unit_in(const std::string& name, std::string& rest) {
  rest = name;
  const std::size_t open = name.find_last_of("([<"), close = name.find_last_of(")]>");
  if (open != std::string::npos && close != std::string::npos && close > open) {
    rest = name.substr(0, open);
    const std::string inside = name.substr(open + 1, close - open - 1);
    if (const auto known = unit_words().find(inside); known != unit_words().end()) return known->second;
    try {
      units::si_unit_of(inside);
      return inside == "1" || inside == "-" ? "1" : inside;
    } catch (const InputError&) {
      return inside == "-" ? "1" : "";
    }
  }
  for (std::size_t at = name.find_last_of("_ /"); at != std::string::npos && at > 0;
       at = name.find_last_of("_ /", at - 1)) {
    std::string tail = name.substr(at + 1);
    std::ranges::replace(tail, '_', '/'); // feed_mm_min
    const auto known = unit_words().find(tail);
    if (known == unit_words().end()) continue;
    rest = name.substr(0, at);
    if (const std::size_t more = rest.find_last_of("_ /"); more != std::string::npos)
      if (const std::string both = ratio(rest.substr(more + 1), tail); !both.empty()) {
        rest = rest.substr(0, more);
        return both;
      }
    return known->second;
  }
  return "";
}

const std::vector<std::pair<std::vector<std::string_view>, double>>& direction_words() {
  static const std::vector<std::pair<std::vector<std::string_view>, double>> all{
      {{"fwd", "forward", "forwards", "up", "+", "cw", "increasing", "out", "outbound", "pos", "positive", "vor",
        "vorwärts", "hin", "auf", "1", "+1", "p", "plus"},
       1},
      {{"bwd",     "backward", "backwards", "bck",  "ccw", "decreasing", "back",     "return",
        "inbound", "rev",      "reverse",   "down", "-",   "neg",        "negative", "zurück",
        "rück",    "rueck",    "ab",        "-1",   "n",   "minus"},
       -1}};
  return all;
}

/// Signs of the words of a direction; empty if they are not such words.
std::vector<std::pair<std::string, double>> signs(const std::set<std::string>& texts) {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& text : texts)
    for (const auto& [words, sign] : direction_words())
      if (std::ranges::find(words, lower(text)) != words.end()) out.emplace_back(text, sign);
  return texts.size() <= 4 && out.size() == texts.size() ? out : std::vector<std::pair<std::string, double>>{};
}

/// The form in which all texts are clock times; empty if there is none.
std::string clock_form(const std::vector<std::string>& texts) {
  for (const char* form : {"iso", "%d.%m.%Y %H:%M:%S", "%d.%m.%Y %H:%M", "%d-%m-%Y %H:%M:%S", "%d/%m/%Y %H:%M:%S",
                           "%Y/%m/%d %H:%M:%S", "%m/%d/%Y %I:%M:%S %p", "%m/%d/%Y %H:%M:%S", "%d.%m.%y %H:%M:%S",
                           "%d-%b-%Y %H:%M:%S", "%I:%M:%S %p", "%H:%M:%S", "%H:%M"}) {
    const ClockFormat format(form);
    if (std::ranges::all_of(texts, [&](const std::string& t) { return format.parse(t).has_value(); })) return form;
  }
  return "";
}

/// Days without a time of the day.
bool are_dates(const std::vector<std::string>& texts) {
  static const std::regex date(R"(\d{4}-\d{1,2}-\d{1,2}|\d{1,2}[./]\d{1,2}[./](\d{4}|\d{2}))");
  return std::ranges::all_of(texts, [](const std::string& t) { return std::regex_match(t, date); });
}

bool is_number(const Csv& csv, const CsvCell& cell, char decimal) {
  try {
    csv.number(cell, decimal);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Whether the cells that are not missing are numbers, more than half of all.
bool numbers(const Csv& csv, std::size_t column, char decimal) {
  std::size_t n = 0;
  for (const auto& row : csv.rows) {
    if (says_missing(row[column].text)) continue;
    if (!is_number(csv, row[column], decimal)) return false;
    ++n;
  }
  return 2 * n > csv.rows.size();
}

std::size_t number_columns(const Csv& csv, char decimal) {
  std::size_t n = 0;
  for (std::size_t c = 0; c < csv.header.size(); ++c) n += numbers(csv, c, decimal);
  return n;
}

/// Whether a column in this unit can be what its name says: T in degC is no time.
bool fits(ColumnRole role, const std::string& unit) {
  if (unit.empty() || unit == "1") return true;
  const std::string si_unit = units::si_unit_of(unit);
  if (role == ColumnRole::time) return si_unit == "s";
  if (role == ColumnRole::temperature) return si_unit == "K";
  return si_unit != "s" && (si_unit != "K" || role == ColumnRole::reading || role == ColumnRole::position ||
                            role == ColumnRole::uncertainty);
}

/// "T", "T_spindle", "T1": a temperature, where "t" is a time.
bool is_temperature_symbol(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return !name.empty() && name.front() == 'T' && (name.size() == 1 || !letter(name[1]));
}

/// Whether the numbers of a column only rise, as times do.
bool rises(const RecognisedData& data, std::size_t column) {
  double last = -HUGE_VAL;
  for (const auto& row : data.csv.rows) {
    if (says_missing(row[column].text)) continue;
    const double x = data.csv.number(row[column], data.decimal);
    if (x <= last) return false;
    last = x;
  }
  return true;
}

/// Temperatures without a unit are in degC where they could be nothing else: a shop at 50 degF freezes.
bool in_degrees_celsius(const RecognisedData& data, std::size_t column) {
  return std::ranges::all_of(data.csv.rows, [&](const auto& row) {
    if (says_missing(row[column].text)) return true;
    const double x = data.csv.number(row[column], data.decimal);
    return x >= 10 && x <= 45;
  });
}

/// @param below  unit below the name; empty: none
RecognisedColumn column_of(const RecognisedData& data, std::size_t c, const std::string& below) {
  RecognisedColumn out{data.csv.header[c].text, "1", ColumnRole::other, numbers(data.csv, c, data.decimal), false, ""};
  std::string rest;
  std::string unit = unit_in(out.name, rest);
  const auto words = words_of(rest);
  if (!below.empty()) unit = below;
  if (unit.empty()) unit = unit_of_time(words);
  if (unit.empty() && lower(out.name) == "rpm") unit = "1/min";
  const bool symbol = out.number && is_temperature_symbol(rest) && fits(ColumnRole::temperature, unit) &&
                      (!unit.empty() || !rises(data, c));
  if (symbol) out.role = ColumnRole::temperature;
  for (const RoleWords& known : role_words()) {
    if (out.role != ColumnRole::other) break;
    for (const std::string_view word : known.words)
      if (std::ranges::find(words, word) != words.end() && fits(known.role, unit)) out.role = known.role;
  }
  if (out.role != ColumnRole::other) out.why = "by its name";
  std::vector<std::string> texts;
  for (const auto& row : data.csv.rows) texts.push_back(row[c].text);
  const std::set<std::string> different(texts.begin(), texts.end());
  if (out.number && unit == "degC" && out.role == ColumnRole::other) {
    out.role = ColumnRole::temperature;
    out.why = "by its unit";
  }
  if (out.role == ColumnRole::direction || out.role == ColumnRole::other) {
    out.words = signs(different);
    // Numbers are a direction only where both signs are there: a column of ones may be anything.
    const auto has = [&](double sign) {
      return std::ranges::count(out.words, sign, [](const auto& w) { return w.second; }) > 0;
    };
    if (out.number && out.role == ColumnRole::other && !(has(1) && has(-1))) out.words.clear();
    if (out.words.empty() && out.role == ColumnRole::direction && !out.number) out.role = ColumnRole::other;
    if (!out.words.empty() && out.role == ColumnRole::other) {
      out.role = ColumnRole::direction;
      out.why = out.number ? "by its signs" : "by its words";
    }
  }
  if (!out.number && (out.role == ColumnRole::other || out.role == ColumnRole::time) && are_dates(texts)) {
    out.role = 2 * different.size() <= texts.size() ? ColumnRole::cycle : ColumnRole::other;
    out.why = "by its dates";
  } else if (!out.number && (out.role == ColumnRole::other || out.role == ColumnRole::time)) {
    out.clock = clock_form(texts);
    if (out.clock.empty()) out.role = ColumnRole::other;
    if (!out.clock.empty() && out.role == ColumnRole::other) {
      out.role = ColumnRole::time;
      out.why = "by its clock times";
    }
  }
  out.gaps = out.number && std::ranges::any_of(different, says_missing);
  if (out.role == ColumnRole::other) out.why.clear();
  const bool plain = out.role == ColumnRole::cycle || out.role == ColumnRole::direction;
  if (out.number && !plain) out.unit = unit.empty() ? "?" : unit;
  if (out.role == ColumnRole::temperature && out.unit == "?" && in_degrees_celsius(data, c)) {
    out.unit = "degC";
    out.why += "; degC by its numbers";
  }
  return out;
}

/// A length, an angle, a force, a torque, a mass, or a number without a unit.
bool is_place(const RecognisedColumn& c) {
  if (c.unit == "?" || c.unit == "1") return true;
  static const std::set<std::string> set_units{"m", "rad", units::si_unit_of("N"), units::si_unit_of("N m"), "kg"};
  return set_units.contains(units::si_unit_of(c.unit));
}

/// Whether a column numbers all rows in their order.
bool numbers_rows(const RecognisedData& data, const RecognisedColumn& c) {
  if (!c.number || c.gaps || !counts_rows(c)) return false;
  const auto column = static_cast<std::size_t>(data.csv.find(c.name));
  const auto value = [&](const auto& row) { return data.csv.number(row[column], data.decimal); };
  return std::ranges::adjacent_find(data.csv.rows, std::greater_equal{}, value) == data.csv.rows.end();
}

} // namespace

void guess_roles(RecognisedData& data) {
  std::vector<RecognisedColumn>& columns = data.columns;
  const auto has = [&](ColumnRole role) {
    return std::ranges::find(columns, role, &RecognisedColumn::role) != columns.end();
  };
  const auto take = [&](auto first, auto end, ColumnRole role, const char* why) {
    const auto fitting = [&](const RecognisedColumn& c) {
      return c.number && c.role == ColumnRole::other && !counts_rows(c) && !names_parts(c) &&
             (role != ColumnRole::position || (is_place(c) && was_set(data, c)));
    };
    // Numbers that recur and have no unit are names, such as those of inserts.
    const auto likely = [&](const RecognisedColumn& c) {
      return fitting(c) && !is_circumstance(c) && !(role == ColumnRole::reading && c.unit == "?" && was_set(data, c));
    };
    auto one = std::find_if(first, end, likely);
    if (one == end) one = std::find_if(first, end, fitting);
    if (one == end) return;
    one->role = role;
    one->why = why;
  };
  // U_mV: a voltage, where nothing else is one that it could be the uncertainty of.
  for (RecognisedColumn& c : columns) {
    if (c.role != ColumnRole::uncertainty || c.unit == "?" || words_of(c.name).front() != "u") continue;
    const auto like = [&](const RecognisedColumn& other) {
      return &other != &c && other.number &&
             (other.unit == "?" || units::convertible(other.unit, units::si_unit_of(c.unit)));
    };
    if (std::ranges::none_of(columns, like)) c.role = ColumnRole::other, c.why.clear();
  }
  // A pressure next to a target is no second position.
  for (bool known = false; RecognisedColumn & c : columns)
    if (c.role == ColumnRole::position && std::exchange(known, true) && c.why == "by its name")
      c.role = ColumnRole::other, c.why.clear();
  if (!has(ColumnRole::reading))
    take(columns.rbegin(), columns.rend(), ColumnRole::reading, "as the last column of numbers");
  if (!has(ColumnRole::reading) && has(ColumnRole::position)) {
    // A force may be what was set or what was read.
    const auto last =
        std::ranges::find(columns.rbegin(), columns.rend(), ColumnRole::position, &RecognisedColumn::role);
    last->role = ColumnRole::reading;
    last->why = "as the last column of numbers";
  }
  if (!has(ColumnRole::position))
    take(columns.begin(), columns.end(), ColumnRole::position, "as the first column of numbers");
  if (has(ColumnRole::time)) return;
  const auto count = std::ranges::find_if(columns, [&](const RecognisedColumn& c) { return numbers_rows(data, c); });
  if (count == columns.end()) return;
  count->role = ColumnRole::time;
  count->unit = "1";
  count->why = "as it counts the readings";
}

bool is_circumstance(const RecognisedColumn& c) {
  static const std::set<std::string> names{"feed",        "feedrate", "vorschub", "speed",
                                           "drehzahl",    "rpm",      "humidity", "feuchte",
                                           "luftfeuchte", "override", "velocity", "acceleration"};
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

bool says_missing(const std::string& text) {
  static const std::set<std::string> words{"",     "nan", "na", "n/a", "#n/a", "null",
                                           "none", "-",   "--", "---", "?",    "missing"};
  return words.contains(lower(text));
}

bool names_parts(const RecognisedColumn& c) {
  static const std::set<std::string> names{
      "operator", "bediener", "observer", "lab",   "laboratory", "batch",   "lot",       "machine", "maschine",
      "sample",   "part",     "specimen", "tool",  "artefact",   "probe",   "sensor",    "day",     "tag",
      "shift",    "wafer",    "rod",      "touch", "hit",        "shot",    "antastung", "insert",  "cavity",
      "nest",     "pose",     "werkzeug", "teil",  "platte",     "schneide"};
  const auto words = words_of(c.name);
  return c.unit == "?" && std::ranges::any_of(words, [&](const std::string& w) { return names.contains(w); });
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

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> out(1);
  for (const char c : lower(name))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0)
      out.back() += c;
    else if (!out.back().empty())
      out.emplace_back();
  if (out.back().empty()) out.pop_back();
  return out;
}

const RecognisedColumn* RecognisedData::find(ColumnRole role) const {
  const auto it = std::ranges::find_if(columns, [&](const RecognisedColumn& c) {
    return c.role == role && (role != ColumnRole::time || c.number || !c.clock.empty());
  });
  return it == columns.end() ? nullptr : &*it;
}

namespace {

/// Line of the column names below other lines: the first that has as many cells as most lines have. 0: the first line,
/// or there is no table.
int line_of_names(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    lines.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  for (const char separator : {';', '\t', ','}) {
    std::map<std::size_t, std::size_t> count; // lines by number of separators
    const auto separators = [&](const std::string& l) {
      return static_cast<std::size_t>(std::ranges::count(l, separator));
    };
    for (const std::string& l : lines) ++count[separators(l)];
    const auto most = std::ranges::max_element(count, {}, [](const auto& c) { return c.second; });
    if (most == count.end() || most->first == 0 || 2 * most->second <= lines.size()) continue;
    const auto names = std::ranges::find(lines, most->first, separators);
    return static_cast<int>(names - lines.begin()) + 1;
  }
  return 0;
}

/// The unit in a cell below a column's name: "mm", "[um]"; empty if it is none.
std::string unit_below(std::string text) {
  if (text.size() > 2 && (text.front() == '[' || text.front() == '(')) text = text.substr(1, text.size() - 2);
  if (const auto known = unit_words().find(text); known != unit_words().end()) return known->second;
  try {
    units::si_unit_of(text);
    return text;
  } catch (const InputError&) {
    return "";
  }
}

/// Takes a first row of units out of the table and into the names, as if it stood there: "pos [mm]".
std::map<std::string, std::string> take_units(RecognisedData& data) {
  std::map<std::string, std::string> out;
  auto& rows = data.csv.rows;
  if (rows.size() < 3) return out;
  for (std::size_t c = 0; c < data.csv.header.size(); ++c) {
    const CsvCell& cell = rows[0][c];
    if (cell.text.empty() || cell.text == "-") continue;
    if (is_number(data.csv, cell, '.') || is_number(data.csv, cell, ',')) return {};
    const std::string unit = unit_below(cell.text);
    if (unit.empty()) return {};
    out[data.csv.header[c].text] = unit;
  }
  if (out.empty()) return out;
  data.first_row = rows[1].front().line;
  rows.erase(rows.begin());
  return out;
}

/// Dates in a column of their own, next to the times of the day.
void find_dates(RecognisedData& data) {
  for (RecognisedColumn& time : data.columns) {
    if (time.clock.empty() || ClockFormat(time.clock).has_date()) continue;
    for (RecognisedColumn& date : data.columns) {
      if (date.number || &date == &time || !date.words.empty()) continue;
      const auto d = static_cast<std::size_t>(data.csv.find(date.name)),
                 t = static_cast<std::size_t>(data.csv.find(time.name));
      std::vector<std::string> texts;
      for (const auto& row : data.csv.rows) texts.push_back(row[d].text + ' ' + row[t].text);
      const std::string form = clock_form(texts);
      if (form.empty()) continue;
      time.clock = form;
      time.date = date.name;
      time.role = ColumnRole::time;
      if (time.why.empty()) time.why = "by its clock times";
      date.role = ColumnRole::time;
      date.why = "with the column " + time.name;
      break;
    }
  }
}

/// "R1+", "Run 2 up": a run's number, and the direction's word where there is one.
struct RunColumn {
  std::size_t column;
  std::string run, direction;
};

std::optional<RunColumn> run_column(const std::string& name, std::size_t column) {
  static const std::regex form(
      R"(\s*(r|run|lauf|cycle|zyklus|messung|reihe|trial|pass|meas|n|)[\s_.#]*(\d+)[\s_.]*([^\s_.\d]*)\s*)",
      std::regex::icase);
  std::smatch match;
  if (!std::regex_match(name, match, form)) return std::nullopt;
  if (!match[3].str().empty() && signs({match[3]}).empty()) return std::nullopt;
  return RunColumn{column, match[2], match[3]};
}

/// Readings of several runs in one row, as a table with one row for each; empty where they are not.
std::string below_each_other(const RecognisedData& data) {
  const auto& header = data.csv.header;
  std::vector<RunColumn> runs;
  std::vector<std::size_t> others;
  for (std::size_t c = 0; c < header.size(); ++c)
    if (const auto run = run_column(header[c].text, c))
      runs.push_back(*run);
    else
      others.push_back(c);
  if (runs.size() < 3 || others.empty()) return "";
  const bool ways = std::ranges::all_of(runs, [](const RunColumn& r) { return !r.direction.empty(); });
  const auto& first = data.csv.rows.front();
  const std::string& below = first[runs.front().column].text; // maybe a line of units
  const bool units = !is_number(data.csv, first[runs.front().column], '.') &&
                     !is_number(data.csv, first[runs.front().column], ',') && !says_missing(below);
  const auto named = [&](const std::string& name, const std::string& unit) {
    return units && !unit.empty() ? fmt::format("{} [{}]", name, unit) : name;
  };
  std::string out;
  for (const std::size_t c : others) out += named(header[c].text, first[c].text) + ';';
  out += fmt::format("run;{}{}\n", ways ? "direction;" : "", named("reading", below));
  for (const RunColumn& run : runs) {
    std::vector<std::string> rows;
    for (std::size_t r = units ? 1 : 0; r < data.csv.rows.size(); ++r) {
      const auto& row = data.csv.rows[r];
      if (says_missing(row[run.column].text)) continue;
      std::string text;
      for (const std::size_t c : others) text += row[c].text + ';';
      rows.push_back(text + fmt::format("{};{}{}\n", run.run, ways ? run.direction + ';' : "", row[run.column].text));
    }
    const auto sign = ways ? signs({run.direction}).front().second : 1.0;
    if (sign < 0) std::ranges::reverse(rows); // as they were taken
    for (const std::string& row : rows) out += row;
  }
  return out;
}

Csv table_of(const std::string& text, const std::string& file, RecognisedData& out) {
  try {
    return parse_csv(text, file);
  } catch (const InputError&) {
    out.header = line_of_names(text);
    if (out.header <= 1) throw;
    return parse_csv(text, file, {.header = out.header});
  }
}

} // namespace

RecognisedData recognise(const std::string& text, const std::string& file) {
  RecognisedData out;
  out.csv = table_of(text, file, out);
  if (out.csv.header.size() == 1 && words_of(out.csv.header[0].text).size() > 1) try { // blanks, if they make a table
      Csv blanks = parse_csv(text, file, {.separator = ' '});
      if (blanks.header.size() > 1) out.csv = std::move(blanks), out.delimiter = "blanks";
    } catch (const InputError&) {
    }
  if (out.csv.rows.empty()) throw InputError(file + ": the file has no rows", "", "write rows under the header");
  if (std::ranges::all_of(out.csv.header,
                          [&](const CsvCell& c) { return is_number(out.csv, c, '.') || is_number(out.csv, c, ','); }))
    throw InputError({{out.csv.at(out.csv.header.front()), "the first row holds numbers, not names of columns", "",
                       "write a line with a name for each column above it"}});
  if (std::string rows = below_each_other(out); !rows.empty()) {
    RecognisedData apart = recognise(rows, file);
    apart.rewritten = std::move(rows);
    return apart;
  }
  const auto below = take_units(out);
  if (number_columns(out.csv, ',') > number_columns(out.csv, '.')) out.decimal = ',';
  for (std::size_t c = 0; c < out.csv.header.size(); ++c) {
    const auto unit = below.find(out.csv.header[c].text);
    out.columns.push_back(column_of(out, c, unit == below.end() ? "" : unit->second));
  }
  find_dates(out);
  guess_roles(out);
  return out;
}

} // namespace gumshoe::scenario
