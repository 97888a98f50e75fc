#pragma once
/// What a unit is, as udunits2 defines it. Private to this folder; `units.h` is what others use.
#include <optional>
#include <string>
#include <vector>

namespace gumshoe::units {

/// Value in base units = factor * number + offset; base as udunits2 writes it, without factor and offset.
struct Unit {
  double factor = 1;
  double offset = 0;
  std::string base;
  int radians = 0;    ///< exponent of the radian, which udunits2 takes for a plain number
  bool ratio = false; ///< a plain number written as a ratio: "um/m", "%"
};

/// The unit as the database of udunits2 has it; none if it is not a unit. The first call reads the database (4 ms).
/// Throws std::runtime_error if that cannot be read. Not for several threads at once.
std::optional<Unit> unit_of_database(const std::string& name);

/// Units that most scenarios use, from a table, so that the database need not be read; none if it is not among them.
/// The bits are those of the database.
std::optional<Unit> common_unit(const std::string& name);
std::vector<std::string> common_unit_names();

} // namespace gumshoe::units
