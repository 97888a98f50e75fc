#include "propagation/all_readings.h"

namespace gumshoe::propagation {

AllReadings all_readings(const ForwardModel& forward, const Points& at) {
  AllReadings out{at, {}};
  out.block.clear(1);
  std::vector<models::Column> row;
  for (std::size_t r = 0; r < at.size(); ++r) {
    forward.subtract_stated(r, out.points[r].data());
    row.clear();
    for (const double& x : out.points[r]) row.push_back({&x, 0});
    forward.add(out.block, r, row);
  }
  return out;
}

} // namespace gumshoe::propagation
