#include "math/senses.h"

#include <algorithm>
#include <cstdlib>

namespace gumshoe {

std::vector<double> senses(std::span<const double> x) {
  std::vector<double> levels(x.begin(), x.end());
  std::ranges::sort(levels);
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  const auto steps = [&](std::size_t i) { // from level to level
    const auto place = [&](double v) { return std::ranges::lower_bound(levels, v) - levels.begin(); };
    return std::abs(place(x[i]) - place(x[i - 1]));
  };
  std::size_t moves = 0, near = 0;
  for (std::size_t i = 1; i < x.size(); ++i) moves += x[i] != x[i - 1], near += steps(i) == 1;
  const auto far = std::max<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(levels.size() / 2));
  const auto anew = [&](std::size_t i) { return 3 * near >= 2 * moves && steps(i) > far; };
  std::vector<double> out(x.size(), 0.0);
  double before = 0;
  for (std::size_t from = 0; from < x.size();) {
    std::size_t to = from;
    while (to < x.size() && x[to] == x[from]) ++to;
    if (from > 0 && anew(from)) before = 0;
    const bool last = to == x.size() || anew(to);
    const double after = last ? before : x[to] > x[from] ? 1 : -1;
    const std::size_t first = before == 0 ? 0 : (to - from + 1) / 2;
    for (std::size_t i = from; i < to; ++i) out[i] = i < from + first ? before : after;
    before = after;
    from = to;
  }
  return out;
}

} // namespace gumshoe
