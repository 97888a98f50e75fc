#include "models/tool_length/trigger/lagging_feed.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

InsertTrigger lagging_trigger(TriggerSolver& solver, std::span<const Flute<double>> flutes, const Beam<double>& beam,
                              const InsertMotion& motion, double lag) {
  InsertTrigger low = solver.solve(flutes, beam, motion); // without lag the tool stands lower
  if (lag == 0 || low.status != Status::ok) return low;
  const auto on = [&](double through, double height, double drop) { // a straight feed through one point
    return solver.solve(flutes, beam, {motion.start_angle, height + drop * through, drop, through});
  };
  const auto height = [&](double turned) { return motion.start_height - motion.drop * (turned - behind(turned, lag)); };
  const auto finished = [&](InsertTrigger result) {
    result.height = height(result.turned);
    return result;
  };
  // When all is moving the tool stands lag rad higher: above the true height, and on it once the exponential is spent.
  const double steady = motion.start_height + motion.drop * lag;
  InsertTrigger high = on(low.turned, steady - motion.drop * low.turned, motion.drop);
  for (int i = 0; i < 60; ++i) {
    const double from = low.turned, width = high.turned - from, left = falling_behind(from, lag);
    if (motion.drop * lag * left < 1e-18 || !(width > 1e-12 + 1e-15 * high.turned)) return finished(high);
    low = on(from, height(from), motion.drop * (1 + left * lag * std::expm1(-width / lag) / width));
    const double fall = motion.drop * (1 - falling_behind(low.turned, lag));
    if (!(fall > 0)) continue;
    const InsertTrigger tangent = on(low.turned, height(low.turned), fall);
    if (tangent.turned < high.turned) high = tangent;
  }
  low.status = Status::not_converged;
  return low;
}

} // namespace gumshoe::models::tool_length
