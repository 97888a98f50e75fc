#include "calibration/compensation_left.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::calibration {
namespace {

double at(const AppliedTable::Curve& curve, double x) {
  const auto next = std::ranges::lower_bound(curve, x, {}, [](const auto& point) { return point.first; });
  if (next == curve.begin()) return next->second;
  if (next == curve.end()) return curve.back().second;
  const auto& [x0, e0] = *(next - 1);
  const auto& [x1, e1] = *next;
  return e0 + (x - x0) / (x1 - x0) * (e1 - e0);
}

/// `direction` 0: not known, so the mean of both.
double corrected(const AppliedTable& table, const Compensation::Deviation& reading) {
  if (table.up.empty() || table.down.empty()) return at(table.up.empty() ? table.down : table.up, reading.position);
  const double up = at(table.up, reading.position), down = at(table.down, reading.position);
  return reading.direction > 0 ? up : reading.direction < 0 ? down : (up + down) / 2;
}

} // namespace

std::vector<Left> left_with(const Compensation& compensation, const AppliedTable& table) {
  std::vector<Left> out;
  for (const Compensation::Group& group : compensation.groups) {
    double squares[3] = {}, n = 0;
    for (const Compensation::Deviation& r : group.readings) {
      const double rest[] = {r.as_read, r.as_read - corrected(table, r), r.unexplained};
      for (int i = 0; i < 3; ++i) squares[i] += r.repeats * rest[i] * rest[i];
      n += r.repeats;
    }
    out.push_back({group.which, std::sqrt(squares[0] / n), std::sqrt(squares[1] / n), std::sqrt(squares[2] / n)});
  }
  return out;
}

} // namespace gumshoe::calibration
