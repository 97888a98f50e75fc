#include "base/units.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <udunits2.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/unit_definition.h"
#include "base/unit_words.h"

namespace gumshoe::units {
namespace {

/// udunits reads "mm 3" as 3 mm and "mm@3" as a shifted scale: allow only names, exponents and * / . ^ ( ).
bool plain_grammar(const std::string& unit) {
  if (unit.starts_with("1e-") && unit.find_first_not_of("0123456789", 3) == std::string::npos) return true;
  if (std::string_view("*/.^-").find(unit.back()) != std::string_view::npos) return false;
  int open = 0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const char c = unit[i];
    open += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (open < 0) return false;
    if (starts_number(c)) {
      const char before = i ? unit[i - 1] : '\0';
      const bool exponent = i && (letter(before) || before == '-' || before == '^' || starts_number(before));
      // "1", "1/min", "um/(1/min)"
      const bool one =
          c == '1' && (i == 0 || before == '(') && (unit.size() == 1 || (i + 1 < unit.size() && unit[i + 1] == '/'));
      if (!exponent && !one) return false;
    } else if (c == '-') {
      if (i == 0 || !(letter(unit[i - 1]) || unit[i - 1] == '^')) return false;
    } else if (!letter(c) && std::string_view("*/.^()%'\" ").find(c) == std::string_view::npos) {
      return false;
    }
  }
  return open == 0;
}

int radian_exponent(const std::string& base) {
  for (std::size_t at = base.find("rad"); at != std::string::npos; at = base.find("rad", at + 1)) {
    const char after = at + 3 < base.size() ? base[at + 3] : '\0';
    if ((at && letter(base[at - 1])) || letter(after)) continue;
    return after == '-' || starts_number(after) ? std::atoi(base.c_str() + at + 3) : 1;
  }
  return 0;
}

void sharpen(Unit& unit) {
  for (const double constant : {1.0, std::numbers::pi}) {
    for (const bool inverse : {false, true}) {
      const double whole = inverse ? constant / unit.factor : unit.factor / constant;
      const double rounded = std::round(whole);
      if (rounded >= 1 && rounded < 9e15 && std::abs(whole / rounded - 1) < 2e-14) {
        unit.factor = inverse ? constant / rounded : rounded * constant;
        return;
      }
    }
  }
}

/// "0.555555555555556 K @ 459.67" has a factor, a base and an offset in its own unit.
std::optional<Unit> read_definition(std::string text, const std::string& name) {
  if (text.find('(') != std::string::npos) return std::nullopt; // logarithmic
  Unit unit;
  if (const std::size_t at = text.find(" @ "); at != std::string::npos) {
    unit.offset = std::atof(text.c_str() + at + 3);
    text.resize(at);
  }
  char* end = nullptr;
  if (const double factor = std::strtod(text.c_str(), &end); end != text.c_str() && *end == ' ') {
    unit.factor = factor;
    text.erase(0, static_cast<std::size_t>(end - text.c_str()) + 1);
  }
  // Fifteen printed digits of degrees and minutes are not enough: take the factor from its inverse where
  // that is a whole number, and from pi for angles.
  unit.base = text;
  unit.radians = radian_exponent(text);
  sharpen(unit);
  unit.offset *= unit.factor;
  unit.ratio = unit.base == "1" && name != "1";
  return unit;
}

/// Units that were asked for, kept until the program ends: they may be read while it does. For any number of threads.
const Unit* find(const std::string& name) {
  static std::mutex mutex;
  static auto* const known = new std::map<std::string, std::optional<Unit>>;
  const std::lock_guard lock(mutex);
  auto at = known->find(name);
  if (at == known->end()) {
    std::optional<Unit> unit = common_unit(name);
    if (!unit) unit = unit_of_database(name);
    at = known->emplace(name, std::move(unit)).first;
  }
  return at->second ? &*at->second : nullptr;
}

std::string without(std::string base, std::string_view word) {
  for (std::size_t at = base.find(word); at != std::string::npos; at = base.find(word)) {
    std::size_t end = at + word.size();
    while (end < base.size() && (base[end] == '-' || starts_number(base[end]))) ++end;
    base.erase(at, end - at);
  }
  std::erase(base, '.');
  return base == "1" ? std::string() : base;
}

bool same_kind(const Unit& a, const Unit& b) {
  if (a.radians != b.radians) return a.ratio && b.base == "rad"; // um/m is a small angle; Hz is not rad/s
  return a.radians ? without(a.base, "rad") == without(b.base, "rad") : a.base == b.base;
}

struct KindOfUnit {
  std::string_view si_unit, name, remedy;
};
constexpr KindOfUnit kinds[] = {
    {"m", "a length", "use mm or um"},
    {"rad", "an angle", "use deg or mrad"},
    {"s", "a time", "use s or ms"},
    {"1", "a plain number", "use a number, % or um/m"},
    {"m/s", "a speed", "use mm/min or m/s"},
    {"m/s2", "an acceleration", "use m/s2"},
    {"rad/s", "an angular speed", "use rpm or rad/s"},
    {"K", "a temperature", "use K or degC"},
    {"1/K", "a relative change per temperature", "use um/m/K or 1/K"},
    {"m/K", "a length per temperature", "use um/K"},
    {"1/s", "a frequency", "use Hz"},
    {"kg", "a mass", "use kg"},
    {"N", "a force", "use N"},
    {"m2", "an area", "use mm2"},
    {"m3", "a volume", "use mm3"},
    {"m-1", "a curvature", "use 1/mm"},
    {"kg/m3", "a density", "use kg/m3"},
    {"Pa", "a pressure", "use Pa or bar"},
    {"J", "an energy", "use J"},
    {"W", "a power", "use W"},
    {"A", "an electric current", "use A or mA"},
    {"V", "a voltage", "use V or mV"},
    {"ohm", "an electric resistance", "use ohm"},
    {"mol", "an amount of substance", "use mol"},
    {"s.A", "an electric charge", "use C, the coulomb; degC are degrees Celsius"},
};

const KindOfUnit* row(const std::string& si_unit) {
  for (const KindOfUnit& r : kinds)
    if (r.si_unit == si_unit) return &r;
  return nullptr;
}

/// "Kg" and "KHZ" are written "kg" and "kHz": the first of a few spellings that is a unit; empty: none.
std::string other_case(const std::string& unit) {
  std::string all = unit;
  for (char& c : all) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::string first = unit;
  first[0] = all[0];
  for (const std::string& one : {first, all})
    if (one != unit && find(one)) return one;
  return "";
}

InputError unknown(const std::string& unit, const std::string& remedy) {
  const std::string meant = unit.empty() ? "" : other_case(unit), instead = instead_of(unit);
  return InputError(fmt::format("'{}' is not a unit", unit), "",
                    !instead.empty() ? instead
                    : !meant.empty() ? "did you mean '" + meant + "'?"
                    : remedy.empty() ? "write one such as mm, um/m, N or degC"
                                     : remedy);
}

struct Pair {
  const Unit& from;
  const Unit& to;
};

Pair pair(const std::string& unit, const std::string& si_unit) {
  const Unit* const from = find(unit);
  const Unit* const to = find(si_unit);
  const KindOfUnit* const r = row(si_unit);
  const std::string remedy(r ? r->remedy : std::string_view());
  if (!from) throw unknown(unit, remedy);
  if (!to) throw InputError(fmt::format("'{}' is not a unit", si_unit));
  if (!same_kind(*from, *to)) {
    throw InputError(fmt::format("'{}' is not {}", unit, kind_name(si_unit)),
                     si_unit == "1" ? "must be dimensionless" : "must convert to " + si_unit, remedy);
  }
  return {*from, *to};
}

/// x * factor, rounded once where the factor is one over a whole number: 0.6 mm is exactly 0.6 / 1000.
double times(double x, double factor) {
  const double inverse = 1 / factor;
  if (factor < 1 && std::round(inverse) == inverse) return x / inverse;
  return x * factor;
}
double over(double x, double factor) {
  const double inverse = 1 / factor;
  if (factor < 1 && std::round(inverse) == inverse) return x * inverse;
  return x / factor;
}

} // namespace

std::optional<Unit> unit_of_database(const std::string& name) {
  if (name.empty() || !plain_grammar(name) || !instead_of(name).empty()) return std::nullopt;
  static ut_system* system = nullptr;
  require_memory(std::size_t{1} << (system ? 20 : 23)); // its parser ends the process where it gets none
  if (!system) {
    ut_set_error_message_handler(ut_ignore);
    system = ut_read_xml(nullptr);
    if (!system) // no error of the input: whoever tries another unit is not to go on without this one
      throw std::runtime_error(
          "the unit database of udunits2 cannot be read (it belongs to the package libudunits2-data)");
  }
  const auto text_of_unit = for_database(name, system);
  const UnitPointer unit(text_of_unit ? ut_parse(system, text_of_unit->c_str(), UT_UTF8) : nullptr);
  if (!unit) return std::nullopt;
  char text[256];
  const int length = ut_format(unit.get(), text, sizeof text, UT_ASCII | UT_DEFINITION);
  if (length < 0 || length >= static_cast<int>(sizeof text)) return std::nullopt;
  return read_definition(std::string(text, static_cast<std::size_t>(length)), name);
}

namespace {

/// "d3" directly behind a number: an exponent in Fortran, not a power of days.
bool begins_exponent(std::string_view text) {
  if (text.empty() || (text[0] != 'd' && text[0] != 'D')) return false;
  const std::size_t digit = text.size() > 1 && (text[1] == '-' || text[1] == '+') ? 2 : 1;
  return text.size() > digit && starts_number(text[digit]);
}

} // namespace

Measure parse(std::string_view text) {
  const auto trim = [](std::string_view s) {
    const auto first = s.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return std::string_view();
    return s.substr(first, s.find_last_not_of(" \t\r\n") - first + 1);
  };
  const std::string_view whole = trim(text);
  const bool plus = whole.starts_with('+') && whole.size() > 1 && whole[1] != '-';
  const char* const begin = whole.data() + plus;
  const char* const end = whole.data() + whole.size();
  Measure measure;
  const auto [stop, error] = std::from_chars(begin, end, measure.number);
  const auto refuse = [&](std::string why) {
    throw InputError(fmt::format("'{}' is not a number with a unit", text), std::move(why),
                     "write it with a unit, such as \"0.6 um\"");
  };
  if (error == std::errc::result_out_of_range) refuse("it is too large or too small for a floating-point number");
  if (error != std::errc() || stop == begin) refuse("it does not begin with a number");
  if (!std::isfinite(measure.number)) refuse("it is not finite");
  if (stop != end && *stop == ',') refuse("the decimal sign must be a point");
  if (stop != end && (*stop == '_' || *stop == '.')) refuse("only one number may stand here");
  if (begins_exponent({stop, static_cast<std::size_t>(end - stop)}))
    refuse("the exponent is written with e, as in 1e3");
  measure.unit = trim({stop, static_cast<std::size_t>(end - stop)});
  if (measure.unit.empty()) measure.unit = "1";
  return measure;
}

namespace {

double to_si(double number, const Pair& p, Kind kind) {
  const double base = times(number, p.from.factor) + (kind == Kind::point ? p.from.offset - p.to.offset : 0.0);
  return p.to.factor == 1 ? base : over(base, p.to.factor);
}

double from_si(double value, const Pair& p, Kind kind) {
  const double base = p.to.factor == 1 ? value : times(value, p.to.factor);
  return over(base - (kind == Kind::point ? p.from.offset - p.to.offset : 0.0), p.from.factor);
}

} // namespace

double to_si(double number, const std::string& unit, const std::string& si_unit, Kind kind) {
  return to_si(number, pair(unit, si_unit), kind);
}

double from_si(double value, const std::string& unit, const std::string& si_unit, Kind kind) {
  return from_si(value, pair(unit, si_unit), kind);
}

void to_si(std::span<double> values, const std::string& unit, const std::string& si_unit) {
  const Pair p = pair(unit, si_unit);
  for (double& x : values) x = to_si(x, p, Kind::point);
}

void from_si(std::span<double> values, const std::string& unit, const std::string& si_unit) {
  const Pair p = pair(unit, si_unit);
  for (double& x : values) x = from_si(x, p, Kind::point);
}

bool convertible(const std::string& unit, const std::string& si_unit) {
  const Unit* const from = find(unit);
  const Unit* const to = find(si_unit);
  return from && to && same_kind(*from, *to);
}

std::string si_unit_of(const std::string& unit) {
  const Unit* const known = find(unit);
  if (!known) throw unknown(unit, "");
  for (const KindOfUnit& r : kinds)
    if (const Unit* const si = find(std::string(r.si_unit));
        si && si->base == known->base && si->radians == known->radians)
      return std::string(r.si_unit);
  return known->base;
}

std::string base_units_of(const std::string& unit) {
  const Unit* const known = find(unit);
  if (!known) throw unknown(unit, "");
  return known->base;
}

std::string suffix(std::string_view unit) { return unit == "1" ? std::string() : " " + std::string(unit); }

std::string quotient(const std::string& above, const std::string& below) {
  if (below == "1") return above;
  return below.find_first_of("/. *") == std::string::npos ? above + '/' + below : above + "/(" + below + ')';
}

std::string difference_unit(const std::string& unit, const std::string& si_unit) {
  return to_si(0, unit, si_unit) == 0 ? unit : si_unit;
}

std::string error_unit(const std::string& unit, const std::string& si_unit, double size) {
  if (si_unit != "m") return unit;
  if (!(size >= 1e-6) && to_si(1, unit, si_unit) < 1e-8) return "nm";
  return !(size >= 1e-3) ? "um" : size < 1 ? "mm" : "m";
}

std::string kind_name(const std::string& si_unit) {
  const KindOfUnit* const r = row(si_unit);
  return r ? std::string(r->name) : "convertible to " + si_unit;
}

} // namespace gumshoe::units
