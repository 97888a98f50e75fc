#pragma once
/// The names in a unit: which of them are units, and what the database of udunits2 has to read in their place. Private
/// to this folder; `units.h` is what others use.
#include <memory>
#include <optional>
#include <string>

#include <udunits2.h>

namespace gumshoe::units {

struct FreeUnit {
  void operator()(ut_unit* u) const { ut_free(u); }
};
using UnitPointer = std::unique_ptr<ut_unit, FreeUnit>;

constexpr bool starts_number(char c) { return c >= '0' && c <= '9'; }
constexpr bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
}

/// What to write instead of a unit that people read in two ways, of a logarithmic one, of one with a remark in brackets
/// or of a power of zero; empty: nothing is known.
std::string instead_of(const std::string& unit);

/// The unit as the database is to read it: names that it lacks, or has with values from before 2019, are replaced. None
/// if a name is no unit. A name may have one prefix of the SI, if prefixes are used with it: udunits alone takes "kph"
/// for kilophots and "Min" for mega-inches.
std::optional<std::string> for_database(const std::string& unit, ut_system* system);

} // namespace gumshoe::units
