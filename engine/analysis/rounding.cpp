#include "analysis/rounding.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gumshoe::analysis {

int decimals_for(double u) {
  if (!(u > 0) || !std::isfinite(u)) return 6;
  int decimals = 1 - static_cast<int>(std::floor(std::log10(u)));
  // 0.0996 rounds to 0.10: two digits again.
  if (std::round(u * std::pow(10.0, decimals)) >= 100) --decimals;
  return std::clamp(decimals, -15, 15);
}

std::string fixed(double value, int decimals) {
  if (decimals >= 0) return fmt::format("{:.{}f}", value, decimals);
  const double step = std::pow(10.0, -decimals);
  return fmt::format("{:.0f}", std::round(value / step) * step);
}

} // namespace gumshoe::analysis
