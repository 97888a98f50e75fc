#pragma once
/// Units of measurement. The only door to udunits2. Inside the engine everything is SI
/// (m, rad, s, m/s, K, 1, 1/K ...); conversion happens here, at the edges.
#include <span>
#include <string>
#include <string_view>

namespace gumshoe::units {

/// Whether a value is a point on a scale (20 degC = 293.15 K) or a difference, width or standard
/// uncertainty on it (1 degC = 1 K).
enum class Kind { point, difference };

/// A number with its unit as the user wrote it, such as {0.6, "um"}. The unit is "1" if there was none.
struct Measure {
  double number = 0;
  std::string unit;
};

/// Splits "0.6 um" into number and unit; throws InputError if there is no finite number in front.
Measure parse(std::string_view text);

/// Convert a number in `unit` to a value in `si_unit` and back: to_si(0.6, "um", "m") is 0.6e-6. `si_unit` is a unit as
/// cards state it, such as "m", "m/s" or "1/K".
/// Throw InputError if a unit is unknown or the units do not convert: "'N' is not a length" (must convert to m).
/// An angle is not a plain number: deg does not convert to 1, but um/m converts to rad.
double to_si(double number, const std::string& unit, const std::string& si_unit, Kind kind = Kind::point);
double from_si(double value, const std::string& unit, const std::string& si_unit, Kind kind = Kind::point);

/// Convert points on the scale in place.
void to_si(std::span<double> values, const std::string& unit, const std::string& si_unit);
void from_si(std::span<double> values, const std::string& unit, const std::string& si_unit);

/// True if `unit` is known and converts to `si_unit`.
bool convertible(const std::string& unit, const std::string& si_unit);

/// The SI unit of values in `unit` inside the engine: "mm" -> "m", "degC" -> "K", "mm/min" -> "m/s". Throws
/// InputError if it is not a unit.
std::string si_unit_of(const std::string& unit);

/// `unit` in the base units of the SI and rad, without factor: "mN" -> "m.kg.s-2", "deg" -> "rad", "%" -> "1". Throws
/// InputError if it is not a unit.
std::string base_units_of(const std::string& unit);

/// What follows a number in `unit`: " um"; nothing after a plain number, the unit of which is "1".
std::string suffix(std::string_view unit);

/// The unit of a ratio: "um/K", "um/(1/K)", "1/kN"; `above` alone over a plain number.
std::string quotient(const std::string& above, const std::string& below);

/// Unit of differences, widths and standard uncertainties on the scale of `unit`: itself; of a scale with a zero of its
/// own, such as degC or degF, the SI unit K.
std::string difference_unit(const std::string& unit, const std::string& si_unit);

/// Unit in which an error of this size (SI) of what is read in `unit` is shown: of lengths nm, where they are read so
/// finely, um, mm or m, as suits it; else `unit`. Without a size that of small errors.
std::string error_unit(const std::string& unit, const std::string& si_unit, double size = 0);

/// Name of a quantity of this SI unit in messages: m -> "a length", rad -> "an angle".
std::string kind_name(const std::string& si_unit);

} // namespace gumshoe::units
