#include "base/dimension.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe {
namespace {
constexpr std::string_view names[] = {"rad", "m", "kg", "s", "A", "K", "mol", "cd"};
/// Exponents are sums and products of what people write: 1/3 * 3 is 1.
bool same(double a, double b) { return std::fabs(a - b) < 1e-9; }
} // namespace

/// Drops the radian unless it marks an angle, an angular speed or an angular acceleration.
Dimension& Dimension::settled() {
  for (double& e : exponents_)
    if (same(e, std::round(e))) e = std::round(e);
  bool kept = exponents_[radian] == 1;
  for (std::size_t i = 0; i < count; ++i) kept &= i == radian || i == second || exponents_[i] == 0;
  if (!kept) exponents_[radian] = 0;
  return *this;
}

Dimension Dimension::of(const std::string& unit) {
  Dimension out;
  const std::string base = units::base_units_of(unit);
  for (std::size_t at = 0; at < base.size();) {
    const std::size_t end = std::min(base.find('.', at), base.size());
    const std::string_view factor(base.data() + at, end - at);
    const std::size_t digits = std::min(factor.find_first_of("-0123456789"), factor.size());
    for (std::size_t i = 0; i < count; ++i)
      if (factor.substr(0, digits) == names[i])
        out.exponents_[i] += digits == factor.size() ? 1 : std::stoi(std::string(factor.substr(digits)));
    at = end + 1;
  }
  return out.settled();
}

Dimension Dimension::angle() {
  Dimension out;
  out.exponents_[radian] = 1;
  return out;
}

Dimension Dimension::operator*(const Dimension& other) const {
  Dimension out = *this;
  for (std::size_t i = 0; i < count; ++i) out.exponents_[i] += other.exponents_[i];
  return out.settled();
}
Dimension Dimension::operator/(const Dimension& other) const { return *this * other.power(-1); }

Dimension Dimension::power(double exponent) const {
  Dimension out = *this;
  for (double& e : out.exponents_) e *= exponent;
  return exponent == -1 ? out : out.settled(); // 1/rad must survive to cancel against rad
}

Dimension Dimension::joined(const Dimension& other) const { return has_angle() ? *this : other; }

bool Dimension::like(const Dimension& other) const {
  for (std::size_t i = 0; i < count; ++i)
    if (i != radian && !same(exponents_[i], other.exponents_[i])) return false;
  return true;
}

bool Dimension::has_unit() const {
  for (const double e : exponents_)
    if (!same(e, std::round(e))) return false;
  return true;
}

std::string Dimension::si_unit() const {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (exponents_[i] == 0) continue;
    text += (text.empty() ? "" : ".") + std::string(names[i]);
    if (!same(exponents_[i], std::round(exponents_[i])))
      text += fmt::format("^{:.3g}", exponents_[i]);
    else if (exponents_[i] != 1)
      text += fmt::format("{:.0f}", exponents_[i]);
  }
  if (text.empty()) return "1";
  return has_unit() ? units::si_unit_of(text) : text;
}

std::string Dimension::words() const {
  const std::string unit = si_unit();
  if (!has_unit()) return "a quantity in " + unit;
  const std::string name = units::kind_name(unit);
  return name.starts_with("convertible") ? "a quantity in " + unit : name;
}

} // namespace gumshoe
