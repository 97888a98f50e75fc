#pragma once
/// The vocabulary of data files: what names of columns, units and cells say, in English and German.
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gumshoe::scenario {

enum class ColumnRole { other, position, reading, direction, time, temperature, cycle, alignment, label, uncertainty };
constexpr const char* name(ColumnRole r) {
  constexpr const char* names[] = {"other",       "position", "reading",   "direction", "time",
                                   "temperature", "cycle",    "alignment", "label",     "uncertainty"};
  return names[static_cast<int>(r)];
}

/// The words of a column's or quantity's name in lower case: "Spindle-Z [mm]" -> spindle, z.
std::vector<std::string> words_of(const std::string& name);

/// Role of a column by the words of its name, if it can have this unit (empty: not known): T in degC is no time.
ColumnRole role_by_name(const std::vector<std::string>& words, const std::string& unit);
/// "T", "T_spindle", "T1": a temperature, where "t" is a time; if it can have this unit.
bool is_temperature_symbol(const std::string& name, const std::string& unit);

/// "pos (mm)", "pos [mm]", "pos_mm", "pos/mm", "pos mm": the unit, or empty; `rest` is the name without it.
std::string unit_in(const std::string& name, std::string& rest);
/// The unit of a quantity that is named after it: "minutes", "rpm"; empty of any other name.
std::string unit_by_name(const std::vector<std::string>& words);
/// The unit in a cell below a column's name: "mm", "[um]"; empty if it is none.
std::string unit_below(std::string text);

/// Signs of the words of a direction; empty if they are not such words.
std::vector<std::pair<std::string, double>> signs(const std::set<std::string>& texts);
/// The form in which all texts are clock times or dates (base/clock.h); empty if there is none, or if days and months
/// could be read in either way.
std::string clock_form(const std::vector<std::string>& texts);
/// Why texts that should be times have no such form, with a remedy.
std::string why_no_clock(const std::vector<std::string>& texts);
/// Days without a time of the day.
bool are_dates(const std::vector<std::string>& texts);
/// Whether a cell among numbers says that there is none: "NaN", "-".
bool says_missing(const std::string& text);

} // namespace gumshoe::scenario
