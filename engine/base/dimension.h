#pragma once
/// Dimensions of quantities: exponents of the SI base units and of the radian, closed under products and powers.
///
/// The radian is a plain number in the SI. It is kept only where it tells an angle from a number, in rad, rad/s and
/// rad/s2; everywhere else it is dropped: radius times angle is a length.
#include <array>
#include <string>

namespace gumshoe {

class Dimension {
public:
  /// A plain number.
  Dimension() = default;
  /// Of a unit: "mm" is a length. Throws InputError if it is no unit.
  static Dimension of(const std::string& unit);
  static Dimension angle();

  Dimension operator*(const Dimension& other) const;
  Dimension operator/(const Dimension& other) const;
  Dimension power(double exponent) const;
  /// Of a sum of both, where they are alike: an angle plus a plain number is an angle.
  Dimension joined(const Dimension& other) const;

  /// The same; the radian counts as a plain number.
  bool like(const Dimension& other) const;
  bool plain() const { return like(Dimension()); }
  bool has_angle() const { return exponents_[radian] != 0; }
  bool is_angle() const { return has_angle() && plain(); }

  /// False for roots that no unit has, sqrt(m).
  bool has_unit() const;
  /// "m", "m/s", "ohm"; the base units with their exponents where the SI has no short name.
  std::string si_unit() const;
  /// "a length", "an angle", "a quantity in m.kg".
  std::string words() const;

private:
  static constexpr std::size_t radian = 0, second = 3, count = 8;
  Dimension& settled();
  std::array<double, count> exponents_{};
};

} // namespace gumshoe
