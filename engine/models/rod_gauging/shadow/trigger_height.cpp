#include "models/rod_gauging/shadow/shadow.h"

#include "models/rod_gauging/shadow/trigger_height.h"

namespace gumshoe::models::rod_gauging {

Solved<double> trigger_height(const Rod<double>& rod, const Beam<double>& beam) {
  const auto fast = solve_chord<double>(shadow_edge(rod, beam), beam.radius, beam.fraction);
  if (fast.failed == 0) return {bottom_height_of(fast.k, rod, beam), Status::ok};
  return general_height(rod, beam);
}

} // namespace gumshoe::models::rod_gauging
