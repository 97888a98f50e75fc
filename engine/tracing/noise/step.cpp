#include "tracing/noise/step.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace gumshoe::tracing {
namespace {

struct Known {
  double size, error;
};

} // namespace

/// Euclid's algorithm over all differences, with a bound on what rounding makes of each remainder.
double recorded_step(std::span<const double> values) {
  constexpr double clear = 100; // times its error: a remainder that is one
  double largest = 0;
  for (const double x : values) largest = std::max(largest, std::fabs(x));
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * largest;
  Known step{0, 0};
  for (const double x : values) {
    Known a{std::fabs(x - values.front()), rounding}, b = step;
    if (a.size <= rounding) continue;
    if (a.size < b.size) std::swap(a, b);
    while (b.size > clear * b.error) {
      const double left = std::fabs(std::remainder(a.size, b.size)), error = a.error + a.size / b.size * b.error;
      a = std::exchange(b, Known{left > 2 * error ? left : 0, error});
    }
    if (b.size > 0) return 0; // too fine to tell
    step = a;
  }
  return step.size;
}

double recorded_step(std::span<const double> values, long together, double stated) {
  const double found = static_cast<double>(together) * recorded_step(values);
  constexpr double whole = 1e-3; // of a step
  if (!(stated > 0)) return found;
  if (found == 0) return std::ranges::adjacent_find(values, std::not_equal_to()) == values.end() ? stated : 0;
  return std::fabs(std::remainder(found, stated)) < whole * stated && found > stated / 2 ? stated : found;
}

} // namespace gumshoe::tracing
