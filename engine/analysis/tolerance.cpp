#include "analysis/tolerance.h"

#include <cmath>
#include <limits>

#include "base/units.h"

namespace gumshoe::analysis {

double numerical_tolerance(double u, int digits, const propagation::Output& output) {
  if (!(u > 0 && std::isfinite(u))) return std::numeric_limits<double>::infinity(); // no digit of u to keep
  const double factor = units::from_si(1, output.unit, output.si_unit, units::Kind::difference);
  int exponent = static_cast<int>(std::floor(std::log10(u * factor))) - (digits - 1);
  if (std::round(u * factor / std::pow(10.0, exponent)) >= std::pow(10.0, digits)) ++exponent;
  return 0.5 * std::pow(10.0, exponent) / factor;
}

} // namespace gumshoe::analysis
