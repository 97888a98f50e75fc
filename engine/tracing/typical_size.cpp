#include "tracing/typical_size.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/units.h"

namespace gumshoe::tracing {

double typical_size(const QuantityCard& card, double* low) {
  const std::string text(card.typical), unit(card.unit), si(card.si_unit);
  char* end = nullptr;
  const double first = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return 0;
  double second = first;
  for (const std::string_view joint : {"-", " to ", " or "})
    if (std::string_view(end).starts_with(joint)) {
      const char* from = end + joint.size();
      second = std::strtod(from, &end);
      break;
    }
  std::string written = end;
  written = written.substr(0, written.find_first_of(":;,("));
  while (!written.empty() && written.front() == ' ') written.erase(0, 1);
  while (!written.empty() && written.back() == ' ') written.pop_back();
  if (written.empty() || !units::convertible(written, si)) written = unit;
  const auto to = [&](double x) { return units::to_si(x, written, si, units::Kind::difference); };
  if (low) *low = to(first);
  return to(second);
}

std::vector<double> grid_of(const QuantityCard& card) {
  std::vector<double> out{card.default_value};
  double low = 0;
  const double high = typical_size(card, &low);
  if (high > low && low > 0)
    for (int i = 0; i <= 5; ++i) out.push_back(0.5 * low * std::pow(4 * high / low, i / 5.0));
  else if (card.limits.low == 0 && card.limits.high == 1)
    out.insert(out.end(), {0.0, 0.5, 1.0});
  std::vector<double> kept;
  for (const double x : out)
    if (card.limits.contain(x) && std::find(kept.begin(), kept.end(), x) == kept.end()) kept.push_back(x);
  return kept;
}

} // namespace gumshoe::tracing
