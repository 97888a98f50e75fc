#pragma once
/// Dimensions of quantities: exponents of the SI base units and of the radian, closed under products and powers.
///
/// The radian is a plain number in the SI. It is kept only where it distinguishes an angle from a number, in rad, rad/s
/// and rad/s2; everywhere else it is dropped: radius times angle is a length.
#include <array>
#include <string>

namespace gumshoe {

class Dimension {
public:
  /// A plain number.
  Dimension() = default;
  /// Dimension of a unit: "mm" is a length. Throws InputError if it is not a unit.
  static Dimension of(const std::string& unit);
  static Dimension angle();

  Dimension operator*(const Dimension& other) const;
  Dimension operator/(const Dimension& other) const;
  Dimension power(double exponent) const;
  /// Dimension of the sum of two like quantities: an angle plus a plain number is an angle.
  Dimension joined(const Dimension& other) const;

  /// True if the dimensions are equal; the radian counts as a plain number.
  bool like(const Dimension& other) const;
  bool plain() const { return like(Dimension()); }
  bool has_angle() const { return exponents_[radian] != 0; }
  bool is_angle() const { return has_angle() && plain(); }

  /// False for roots without a unit, such as sqrt(m).
  bool has_unit() const;
  /// The SI unit: "m", "m/s", "ohm"; base units with their exponents if the SI has no short name.
  std::string si_unit() const;
  /// Name in messages: "a length", "an angle", "a quantity in m.kg".
  std::string words() const;

private:
  static constexpr std::size_t radian = 0, second = 3, count = 8;
  Dimension& settled();
  std::array<double, count> exponents_{};
};

} // namespace gumshoe
