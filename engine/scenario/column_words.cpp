#include "scenario/column_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <string_view>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
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
      {ColumnRole::cycle,
       {"cycle",    "run",        "repeat",    "repetition", "pass",      "lauf",       "zyklus",   "setup",
        "series",   "reihe",      "messreihe", "serie",      "durchgang", "trial",      "round",    "runde",
        "expt",     "experiment", "versuch",   "replicate",  "rep",       "session",    "sitzung",  "visit",
        "campaign", "sweep",      "lap",       "umlauf",     "rev",       "revolution", "umdrehung"}},
      {ColumnRole::time,
       {"time", "zeit", "timestamp", "datetime", "date", "datum", "clock", "uhrzeit", "t", "elapsed", "seconds",
        "sekunden", "minutes", "minuten", "hours", "stunden", "days", "tage"}},
      {ColumnRole::reading,
       {"dev",      "deviation", "error",      "err",     "abweichung", "reading",    "laser",  "measured",
        "meas",     "actual",    "act",        "ist",     "diff",       "difference", "result", "value",
        "messwert", "wert",      "indication", "anzeige", "signal",     "output",     "ind",    "indicated"}},
      {ColumnRole::position, {"pos",      "position", "target",    "tgt",   "nominal", "nom",   "soll",      "set",
                              "setpoint", "command",  "commanded", "load",  "last",    "ref",   "reference", "referenz",
                              "force",    "kraft",    "pressure",  "druck", "angle",   "winkel"}},
  };
  return all;
}

/// Spellings of units in headers.
const std::map<std::string, std::string>& unit_words() {
  static const std::map<std::string, std::string> all{
      {"um", "um"},         {"µm", "um"},         {"μm", "um"},         {"micron", "um"},     {"nm", "nm"},
      {"mm", "mm"},         {"m", "m"},           {"km", "km"},         {"inch", "inch"},     {"in", "inch"},
      {"deg", "deg"},       {"°", "deg"},         {"rad", "rad"},       {"mrad", "mrad"},     {"urad", "urad"},
      {"µrad", "urad"},     {"arcsec", "arcsec"}, {"s", "s"},           {"sec", "s"},         {"ms", "ms"},
      {"min", "min"},       {"h", "h"},           {"K", "K"},           {"degC", "degC"},     {"°C", "degC"},
      {"C", "degC"},        {"N", "N"},           {"mm/min", "mm/min"}, {"mm/s", "mm/s"},     {"um/m", "um/m"},
      {"%", "%"},           {"ppm", "ppm"},       {"ppb", "ppb"},       {"Hz", "Hz"},         {"kN", "kN"},
      {"MN", "MN"},         {"Nm", "N m"},        {"V", "V"},           {"mV", "mV"},         {"mV/V", "mV/V"},
      {"mVV", "mV/V"},      {"bar", "bar"},       {"mbar", "mbar"},     {"Pa", "Pa"},         {"hPa", "hPa"},
      {"kPa", "kPa"},       {"MPa", "MPa"},       {"kg", "kg"},         {"rpm", "1/min"},     {"1/min", "1/min"},
      {"U/min", "1/min"},   {"m/min", "m/min"},   {"uV", "uV"},         {"µV", "uV"},         {"kV", "kV"},
      {"uA", "uA"},         {"µA", "uA"},         {"mA", "mA"},         {"ohm", "ohm"},       {"Ohm", "ohm"},
      {"kohm", "kohm"},     {"mohm", "mohm"},     {"mT", "mT"},         {"uT", "uT"},         {"µT", "uT"},
      {"psi", "psi"},       {"g", "g"},           {"mg", "mg"},         {"mN", "mN"},         {"Ncm", "N cm"},
      {"mrad/s", "mrad/s"}, {"percent", "%"},     {"pct", "%"},         {"cm", "cm"},         {"dm", "dm"},
      {"ft", "ft"},         {"ns", "ns"},         {"ps", "ps"},         {"us", "us"},         {"µs", "us"},
      {"degF", "degF"},     {"°F", "degF"},       {"mK", "mK"},         {"inHg", "inHg"},     {"mmHg", "mmHg"},
      {"torr", "torr"},     {"Torr", "torr"},     {"atm", "atm"},       {"GPa", "GPa"},       {"kHz", "kHz"},
      {"MHz", "MHz"},       {"GHz", "GHz"},       {"pA", "pA"},         {"nA", "nA"},         {"nV", "nV"},
      {"Mohm", "Mohm"},     {"MOhm", "Mohm"},     {"ohmcm", "ohm cm"},  {"ohm cm", "ohm cm"}, {"pF", "pF"},
      {"nF", "nF"},         {"uF", "uF"},         {"µF", "uF"},         {"mH", "mH"},         {"uH", "uH"},
      {"mW", "mW"},         {"kW", "kW"},         {"kJ", "kJ"},         {"kNm", "kN m"},      {"mL", "mL"},
      {"ml", "mL"},         {"L/min", "L/min"},   {"l/min", "L/min"},   {"mL/min", "mL/min"}, {"ml/min", "mL/min"},
      {"mL/h", "mL/h"},     {"ml/h", "mL/h"},     {"m/s", "m/s"},       {"km/h", "km/h"},     {"kg/m3", "kg/m^3"},
      {"kg/m^3", "kg/m^3"}, {"g/cm3", "g/cm^3"},  {"lx", "lx"},         {"gon", "gon"},       {"kgf", "kgf"},
      {"lbf", "lbf"},       {"lb", "lb"}};
  return all;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
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

const std::vector<std::pair<std::vector<std::string_view>, double>>& direction_words() {
  static const std::vector<std::pair<std::vector<std::string_view>, double>> all{
      {{"fwd",  "forward",  "forwards",  "up",       "+",      "cw",      "increasing", "out",      "outbound",
        "pos",  "positive", "vor",       "vorwärts", "hin",    "auf",     "1",          "+1",       "p",
        "plus", "rising",   "ascending", "loading",  "upward", "upwards", "steigend",   "aufwärts", "belastung"},
       1},
      {{"bwd",       "backward", "backwards", "bck",     "ccw",     "decreasing", "back",     "return",
        "inbound",   "rev",      "reverse",   "down",    "-",       "neg",        "negative", "zurück",
        "rück",      "rueck",    "ab",        "-1",      "n",       "minus",      "falling",  "descending",
        "unloading", "downward", "downwards", "fallend", "abwärts", "entlastung"},
       -1}};
  return all;
}

/// Whether "in" behind these words is the inch: "X_in", "dev in", but not "T_in".
bool is_length(const std::string& name) {
  static const std::set<std::string> lengths{"x",      "y",     "z",        "pos",    "position", "target",   "nominal",
                                             "nom",    "dev",   "deviation", "error", "err",      "length",   "diameter",
                                             "radius", "dia",   "actual",   "act",    "measured", "meas",     "size",
                                             "dx",     "dy",    "dz",       "distance", "reading", "height"};
  const auto words = words_of(name);
  return !words.empty() && lengths.contains(words.back());
}

/// Whether a column in this unit can be what its name says: T in degC is no time, and an approach in um no direction.
bool fits(ColumnRole role, const std::string& unit) {
  if (unit.empty() || unit == "1") return true;
  const std::string si_unit = units::si_unit_of(unit);
  if (role == ColumnRole::direction) return false; // an angle, or a coordinate
  if (role == ColumnRole::time) return si_unit == "s";
  if (role == ColumnRole::temperature) return si_unit == "K";
  return si_unit != "s" && (si_unit != "K" || role == ColumnRole::reading || role == ColumnRole::position ||
                            role == ColumnRole::uncertainty);
}

} // namespace

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

ColumnRole role_by_name(const std::vector<std::string>& words, const std::string& unit) {
  for (const RoleWords& known : role_words())
    for (const std::string_view word : known.words)
      if (std::ranges::find(words, word) != words.end() && fits(known.role, unit)) return known.role;
  return ColumnRole::other;
}

bool is_temperature_symbol(const std::string& name, const std::string& unit) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return fits(ColumnRole::temperature, unit) && !name.empty() && name.front() == 'T' &&
         (name.size() == 1 || !letter(name[1]));
}

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
    if (tail == "in" && !is_length(rest)) {
      rest = name;
      continue;
    }
    if (const std::size_t more = rest.find_last_of("_ /"); more != std::string::npos)
      if (std::string both = ratio(rest.substr(more + 1), tail); !both.empty()) {
        rest = rest.substr(0, more);
        return both;
      }
    return known->second;
  }
  return "";
}

std::string unit_by_name(const std::vector<std::string>& words) {
  static const std::map<std::string, std::string> all{{"seconds", "s"},   {"sekunden", "s"}, {"minutes", "min"},
                                                      {"minuten", "min"}, {"hours", "h"},    {"stunden", "h"},
                                                      {"days", "d"},      {"tage", "d"}};
  for (const std::string& word : words)
    if (const auto known = all.find(word); known != all.end()) return known->second;
  return words == std::vector<std::string>{"rpm"} ? "1/min" : "";
}

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

std::vector<std::pair<std::string, double>> signs(const std::set<std::string>& texts) {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& text : texts)
    for (const auto& [words, sign] : direction_words())
      if (std::ranges::find(words, lower(text)) != words.end()) out.emplace_back(text, sign);
  return texts.size() <= 4 && out.size() == texts.size() ? out : std::vector<std::pair<std::string, double>>{};
}

namespace {

/// All of these texts in this form; empty if one is not.
std::vector<Moment> moments_of(const std::vector<std::string>& texts, const std::string& form) {
  const ClockFormat format(form);
  std::vector<Moment> out;
  for (const std::string& text : texts) {
    const auto moment = format.parse(text);
    if (!moment) return {};
    out.push_back(*moment);
  }
  return out;
}

/// Whether no row is before the one above it.
bool goes_on(const std::vector<Moment>& all) {
  return std::ranges::adjacent_find(all, [](const Moment& a, const Moment& b) { return b.since(a) < 0; }) == all.end();
}

} // namespace

std::string clock_form(const std::vector<std::string>& texts) {
  constexpr std::array hours{" %H:%M:%S", " %H:%M", " %I:%M:%S %p", " %I:%M %p", ""};
  const auto fit = [&](const std::string& form) { return !moments_of(texts, form).empty(); };
  if (fit("iso")) return "iso";
  for (const char* time : {"%I:%M:%S %p", "%I:%M %p", "%H:%M:%S", "%H:%M"})
    if (fit(time)) return time;
  for (const std::string date : {"%d.%m.%Y", "%d.%m.%y", "%d-%m-%Y", "%m-%d-%Y", "%d-%b-%Y", "%Y/%m/%d", "%Y-%m-%d"})
    for (const char* rest : hours)
      if (fit(date + rest)) return date + rest;
  for (const char* year : {"%Y", "%y"})
    for (const std::string rest : hours) {
      const std::string day_first = fmt::format("%d/%m/{}{}", year, rest),
                        month_first = fmt::format("%m/%d/{}{}", year, rest);
      const std::vector<Moment> days = moments_of(texts, day_first), months = moments_of(texts, month_first);
      if (days.empty() && months.empty()) continue;
      if (days.empty() || months.empty()) return days.empty() ? month_first : day_first;
      if (goes_on(days) != goes_on(months)) return goes_on(days) ? day_first : month_first;
      const bool same = std::ranges::equal(
          days, months, [&](const Moment& x, const Moment& y) { return x.since(days[0]) == y.since(months[0]); });
      return !same ? "" : rest.ends_with("%p") ? month_first : day_first;
    }
  return "";
}

std::string why_no_clock(const std::vector<std::string>& texts) {
  if (std::ranges::any_of(texts, says_missing)) return "not every cell has a time";
  static const std::regex slashes(R"(\d{1,2}/\d{1,2}/(\d{4}|\d{2})( .*)?)");
  const auto low = [](const std::string& text) {
    const std::size_t first = text.find('/');
    return std::stoi(text) <= 12 && std::stoi(text.substr(first + 1)) <= 12;
  };
  if (std::ranges::all_of(texts, [&](const std::string& t) { return std::regex_match(t, slashes) && low(t); }))
    return "its days and months may be read in either way: write them as 2026-02-03";
  return "its times are of no known form: write them as 2026-02-03 10:00:00";
}

bool are_dates(const std::vector<std::string>& texts) {
  static const std::regex date(R"(\d{4}-\d{1,2}-\d{1,2}|\d{1,2}[./]\d{1,2}[./](\d{4}|\d{2}))");
  return std::ranges::all_of(texts, [](const std::string& t) { return std::regex_match(t, date); });
}

bool says_missing(const std::string& text) {
  static const std::set<std::string> words{"",     "nan", "na", "n/a", "#n/a", "null",
                                           "none", "-",   "--", "---", "?",    "missing"};
  return words.contains(lower(text));
}

} // namespace gumshoe::scenario
