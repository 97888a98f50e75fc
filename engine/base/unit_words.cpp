#include "base/unit_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace gumshoe::units {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Whether a character of UTF-8 that no name holds begins here: the dot of a product, or an exponent.
bool parts_names(std::string_view text) {
  return std::ranges::any_of(std::array<std::string_view, 3>{"·", "²", "³"},
                             [&](std::string_view one) { return text.starts_with(one); });
}

/// Calls word(name) for the names in a unit, and rest(character) for all between them. A name may hold digits, but ends
/// with a letter: "cmH2O".
template <class Word, class Rest> void each_name(std::string_view unit, const Word& word, const Rest& rest) {
  for (std::size_t i = 0; i < unit.size();) {
    std::size_t end = i;
    if (letter(unit[i]))
      while (end < unit.size() && (letter(unit[end]) || starts_number(unit[end])) && !parts_names(unit.substr(end)))
        ++end;
    while (end > i && starts_number(unit[end - 1])) --end;
    if (end > i) {
      word(std::string(unit.substr(i, end - i)));
      i = end;
    } else {
      for (std::size_t n = parts_names(unit.substr(i)) ? 2 : 1; n > 0; --n) rest(unit[i++]);
    }
  }
}

/// A power of zero makes a plain number of any unit.
bool has_zeroth_power(const std::string& unit) {
  static const std::regex zero(R"([A-Za-z\x80-\xff)^]-?0+(?![0-9]))");
  return std::regex_search(unit, zero);
}

/// Names that udunits does not know, or reads in a way that people do not.
const std::string* known_name(const std::string& word) {
  static const std::map<std::string, std::string> names{
      {"deg", "degree"},
      {"rev", "revolution"},
      {"gon", "(0.9 degree)"},
      {"nmi", "(1852 m)"},
      {"kph", "(km/hour)"},
      {"mph", "(mile/hour)"},
      {"ha", "hectare"},
      {"mdeg", "(0.001 degree)"},
      {"mas", "(0.001 arcsec)"},
      {"mgon", "(0.0009 degree)"},
      {"cgon", "(0.009 degree)"},
      {"permille", "(0.001)"},
      {"‰", "(0.001)"},
      {"kp", "(9.80665 N)"},
      {"P", "poise"},
      {"cP", "(0.01 poise)"},
      {"mmH2O", "(9.80665 Pa)"},
      {"thou", "(0.001 inch)"},
      {"hrs", "hour"},
      {"mins", "minute"},
  };
  const auto known = names.find(word);
  return known == names.end() ? nullptr : &known->second;
}

/// Beginnings of names of units: prefixes of the SI, in words and as symbols.
bool is_prefix(const std::string& text) {
  static const std::vector<std::string> words{"yotta", "zetta", "exa",   "peta", "tera",  "giga",  "mega",
                                              "kilo",  "hecto", "deka",  "deci", "centi", "milli", "micro",
                                              "nano",  "pico",  "femto", "atto", "zepto", "yocto"};
  static const std::vector<std::string> symbols{"Y", "Z", "E", "P", "T", "G", "M", "k", "h", "da", "d",
                                                "c", "m", "µ", "μ", "u", "n", "p", "f", "a", "z",  "y"};
  return std::ranges::find(symbols, text) != symbols.end() || std::ranges::find(words, lower(text)) != words.end();
}

bool is_micro(const std::string& prefix) {
  return prefix == "u" || prefix == "µ" || prefix == "μ" || lower(prefix) == "micro";
}

/// Names that udunits lacks, and torr, which is 1/760 of an atmosphere; each may have a prefix. None: it is no such
/// name.
std::optional<std::string> added_name(const std::string& word) {
  struct Added {
    std::string_view name, factor, unit;
  };
  static constexpr Added all[] = {{"torr", "133.32236842105263 ", "Pa"},
                                  {"Torr", "133.32236842105263 ", "Pa"},
                                  {"Nm", "", "N m"},
                                  {"Wh", "", "W h"},
                                  {"Ah", "", "A h"}};
  for (const Added& a : all)
    if (word.ends_with(a.name))
      if (const std::string prefix = word.substr(0, word.size() - a.name.size()); prefix.empty() || is_prefix(prefix))
        return fmt::format("({}{}{})", a.factor, prefix, a.unit);
  return std::nullopt;
}

/// The names of the database, and which of its units take prefixes.
class Database {
public:
  explicit Database(ut_system* system) : system_(system) {}

  /// The unit of this name, without a prefix; null if there is none.
  UnitPointer find(const std::string& name) const {
    if (ut_unit* const by_name = ut_get_unit_by_name(system_, name.c_str())) return UnitPointer(by_name);
    return UnitPointer(ut_get_unit_by_symbol(system_, name.c_str()));
  }

  bool takes(const std::string& prefix, const ut_unit* unit) const {
    static constexpr std::array names{
        "m",   "g",   "s",   "A",     "K",     "mol",    "cd",    "rad", "sr",   "Hz",      "N",      "Pa",
        "J",   "W",   "C",   "V",     "F",     "ohm",    "S",     "Wb",  "T",    "H",       "lm",     "lx",
        "kat", "Gy",  "VA",  "L",     "t",     "eV",     "bar",   "atm", "b",    "degree",  "arcsec", "rpm",
        "Ci",  "R",   "rem", "Gal",   "poise", "St",     "gauss", "Oe",  "erg",  "dyne",    "pond",   "lbf",
        "psi", "cal", "Btu", "darcy", "tex",   "parsec", "year",  "bit", "byte", "watthour"};
    if (is_micro(prefix) && is(unit, "inch")) return true;
    if (prefix == "k" && (is(unit, "foot") || is(unit, "pound"))) return true;
    if (prefix == "m" && is(unit, "celsius")) return true;
    return std::ranges::any_of(names, [&](const char* name) { return is(unit, name); });
  }

  /// The value since 2019 of a constant that is a unit, as text; empty: it is no such unit.
  /// @param prefix  in front of it; empty: none
  std::string todays_value(const std::string& prefix, const ut_unit* unit) const {
    struct Constant {
      const char *name, *value, *unit;
    };
    // The atomic mass unit is that of CODATA 2022; the others follow from the defining constants of the SI.
    static constexpr Constant all[] = {{"eV", "1.602176634e-19", "J"},
                                       {"bev", "1.602176634e-10", "J"},
                                       {"e", "1.602176634e-19", "C"},
                                       {"faraday", "96485.33212331001", "C"},
                                       {"molecule", "1.6605390671738467e-24", "mol"},
                                       {"u", "1.66053906892e-27", "kg"}};
    for (const Constant& c : all)
      if (is(unit, c.name)) return fmt::format("({} {}{})", c.value, prefix, c.unit);
    return "";
  }

private:
  bool is(const ut_unit* unit, const char* name) const {
    const UnitPointer known = find(name);
    return known && ut_compare(unit, known.get()) == 0;
  }

  ut_system* system_;
};

/// What people read in two ways, or a logarithmic unit; empty: the name is neither.
std::string unclear(const std::string& word) {
  static const std::map<std::string, std::string> all{
      {"ct", "write carat"},
      {"oz", "it may be a mass or a volume: convert to g or mL"},
      {"gal", "it may be a volume or an acceleration: write gallon or cm/s2"},
      {"ton", "it may be metric, American or British: write t, which is 1000 kg, or convert to kg"},
      {"tons", "they may be metric, American or British: write t, which is 1000 kg, or convert to kg"},
      {"db", "logarithmic units are not known: write the ratio"},
      {"np", "logarithmic units are not known: write the ratio"},
  };
  if (word == "Gal") return ""; // of gravity, after Galilei
  if (word == "mb") return "it may be a pressure or an area: write mbar or millibarn";
  const auto found = all.find(lower(word)); // names of the database are known in any case
  return found == all.end() ? "" : found->second;
}

/// A name as the database is to read it; none: it is no unit.
std::optional<std::string> read_name(const std::string& word, const Database& database) {
  if (const std::string* const known = known_name(word)) return *known;
  if (auto added = added_name(word)) return added;
  const auto text = [&](const std::string& prefix, const ut_unit* unit) {
    const std::string value = database.todays_value(prefix, unit);
    return value.empty() ? word : value;
  };
  if (const UnitPointer unit = database.find(word)) return text("", unit.get());
  for (std::size_t n = 1; n < word.size(); ++n) {
    const std::string prefix = word.substr(0, n), rest = word.substr(n);
    if (!is_prefix(prefix) || !unclear(rest).empty()) continue;
    if (const UnitPointer unit = database.find(rest); unit && database.takes(prefix, unit.get()))
      return text(prefix, unit.get());
  }
  return std::nullopt;
}

} // namespace

std::string instead_of(const std::string& unit) {
  // udunits reads "° C" as degrees times coulombs.
  static const std::regex parted(
      R"((^|[^A-Za-z])(°|deg|degs|degree|degrees)\s+([CFK])(elsius|ahrenheit|elvin)?(?![A-Za-z]))");
  if (std::smatch found; std::regex_search(unit, found, parted))
    return fmt::format("write {}{}", found[3] == "K" ? "" : "deg", found[3].str());
  // "bar(g)" is a gauge pressure, and no bar times gram.
  static const std::regex remark(R"(([A-Za-z\x80-\xff]+)\(([A-Za-z]+)\))");
  if (std::smatch found; std::regex_search(unit, found, remark))
    return fmt::format("write '{}' and say elsewhere what is meant by ({}); a product is '{}.{}'", found[1].str(),
                       found[2].str(), found[1].str(), found[2].str());
  // "100 mm +- 1 um"
  static const std::regex give_or_take(R"((\+/?-|\xc2\xb1)\s*(.*))");
  if (std::smatch found; std::regex_search(unit, found, give_or_take))
    return fmt::format("state what is known of the value by keys of its own: u = \"{0}\" if that is the standard "
                       "uncertainty, half_width = \"{0}\" and distribution if these are limits",
                       found[2].str());
  if (has_zeroth_power(unit)) return "a unit to the power of zero is a plain number: leave it out";
  std::string out;
  each_name(
      unit,
      [&](const std::string& word) {
        if (std::string remedy = unclear(word); !remedy.empty()) out = std::move(remedy);
      },
      [](char) {});
  return out;
}

std::optional<std::string> for_database(const std::string& unit, ut_system* system) {
  if (unit.starts_with("1e-")) return unit; // a plain number, whose e is no charge
  const Database database(system);
  std::string out;
  bool all = true;
  each_name(
      unit,
      [&](const std::string& word) {
        const auto name = read_name(word, database);
        all = all && name;
        out += name.value_or("");
      },
      [&](char c) { out += c; });
  return all ? std::optional(out) : std::nullopt;
}

} // namespace gumshoe::units
