#include "analysis/rounding.h"

#include <algorithm>
#include <cmath>

#include <vector>

#include <fmt/format.h>

#include "base/units.h"

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
  if (std::abs(decimals) > 15 && std::isfinite(value)) { // a hundred zeros are no digits
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

std::string with_suitable_unit(double si, const std::string& unit, const std::string& si_unit) {
  static const std::vector<std::vector<std::string>> ladders = {
      {"m", "mm", "um", "nm"}, {"s", "ms", "us", "ns"}, {"kg", "g", "mg", "ug"}, {"rad", "mrad", "urad"},
      {"N", "mN", "uN"},       {"V", "mV", "uV", "nV"}, {"A", "mA", "uA", "nA"}, {"K", "mK", "uK"},
      {"degC", "mK", "uK"},    {"Hz", "mHz", "uHz"}};
  std::string in = unit;
  double x = units::from_si(si, in, si_unit, units::Kind::difference);
  for (const auto& ladder : ladders)
    if (auto at = std::ranges::find(ladder, unit); at != ladder.end())
      while (x != 0 && std::fabs(x) < 0.0095 && ++at != ladder.end())
        x = units::from_si(si, in = *at, si_unit, units::Kind::difference);
  return (x == 0 ? "0" : fixed(x, decimals_for(std::fabs(x)))) + units::suffix(in);
}

std::string effective_freedom(double n) {
  return fmt::format("{:.0f} effective degree{} of freedom", n, n == 1 ? "" : "s");
}

std::string probability_text(double p, double least) {
  const auto percent = [](double x) {
    const double rest = std::fmin(100 * x, 100 - 100 * x); // as many digits as the smaller of both sides needs
    const int decimals = rest > 0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(rest))), 0, 12) : 0;
    return fixed(100 * x, decimals) + " %";
  };
  // One digit of a bound: rounded to the side on which it still holds.
  const double scale = least > 0 ? std::pow(10.0, std::floor(std::log10(least))) : 1;
  const double bound = least > 0 ? std::ceil(least / scale * (1 - 1e-9)) * scale : 0;
  const auto bound_text = [&](double x) {
    return fixed(100 * x, std::max(0, -static_cast<int>(std::floor(std::log10(100 * bound) + 1e-9)))) + " %";
  };
  if (least > 0 && p < least) return "< " + bound_text(bound);
  if (least > 0 && 1 - p < least) return "> " + bound_text(1 - bound);
  return percent(p);
}

std::string coverage_text(double p) {
  constexpr double least = 1e-12;
  const double rest = std::fmin(p, 1 - p);
  if (!(rest >= least)) return probability_text(p, least);
  std::string text = fixed(100 * p, std::max(2, -static_cast<int>(std::floor(std::log10(rest)))));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text + " %";
}

std::string share_text(double share) {
  constexpr double half = 0.005;
  if (std::fabs(share) < half) return "< 1 %";
  if (share > 1 - half && share < 1 + half) return "> 99 %";
  return fmt::format("{:.0f} %", 100 * share);
}

} // namespace gumshoe::analysis
