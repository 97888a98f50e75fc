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
  return decimals;
}

std::string fixed(double value, int decimals) {
  std::string text;
  if (decimals > 15 && std::isfinite(value)) {
    const int digits = value == 0 ? 0 : decimals + static_cast<int>(std::floor(std::log10(std::fabs(value))));
    text = fmt::format("{:.{}e}", digits < 0 ? 0.0 : value, std::clamp(digits, 0, 17));
  } else if (decimals >= 0 || !std::isfinite(value)) {
    text = fmt::format("{:.{}f}", value, std::max(decimals, 0));
  } else {
    const double step = std::pow(10.0, -decimals);
    text = fmt::format("{:.0f}", std::round(value / step) * step);
  }
  // No "-0.0": what rounds to zero has no sign.
  return text.starts_with('-') && text.find_first_of("123456789in") >= std::min(text.find('e'), text.size())
             ? text.substr(1)
             : text;
}

} // namespace gumshoe::analysis
