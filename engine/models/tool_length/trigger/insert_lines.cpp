#include "models/tool_length/trigger/insert_lines.h"

#include <algorithm>

namespace gumshoe::models::tool_length {

InsertLines::InsertLines(const InsertBody<double>& body, const DiscShare& disc)
    : rake_(body), disc_(disc), back_radius_(body.back_radius), tilt_(std::fabs(body.sin_pitch)) {
  const auto length = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
  const double shrink = body.rake_radius - body.back_radius;
  thickness_ = length(body.back.x - body.rake.x, body.back.y - body.rake.y, body.back.z - body.rake.z);
  shrink_share_ = shrink / length(thickness_, shrink, 0);
  normal_spread_ = length(rake_.normal.x, rake_.normal.y, 0);
  spread_[0] = length(body.rake.x, body.rake.y, 0);
  spread_[1] = length(body.back.x, body.back.y, 0);
}

/// The line of slope t at the middle of the interval, and what both circles may add to either side.
double InsertLines::line(const RakeView& v, double t, double half, double fall) const {
  const double q2 = 1 + t * t, along = t * v.ny - v.nz, along1 = t * v.ny1 - v.nz1;
  const double g = std::sqrt(std::max(0.0, q2 - along * along)), move = std::fabs(t) + tilt_;
  // g is the length of a projection of a vector that moves by `move`; smooth while it stays long
  const double far = std::fabs(along) + move * half, g_least2 = q2 - far * far;
  double most = -HUGE_VAL;
  for (int back = 0; back < 2; ++back) {
    const double rho = back ? back_radius_ : rake_.radius, aside = back ? thickness_ : 0;
    const double value = t * (v.cy + aside * v.ny) - v.cz - aside * v.nz;
    const double rate = t * (v.cy1 + aside * v.ny1) - v.cz1 - aside * v.nz1 + fall;
    const double turn = 0.5 * move * spread_[back] * half * half;
    double bound = value + rho * (g + move * half) + std::fabs(rate) * half + turn;
    if (g_least2 > 0) {
      const double bent = 0.5 * rho * far * move * normal_spread_ / std::sqrt(g_least2) * half * half;
      bound = std::min(bound, value + rho * g + std::fabs(rate - rho * along * along1 / g) * half + turn + bent);
    }
    most = std::max(most, bound);
  }
  return most + disc_.radius * disc_.depth * std::sqrt(q2) + fall * half;
}

/// Whether the whole insert misses the beam.
bool InsertLines::misses(const RakeView& v, double half) const {
  const double extent = std::sqrt(1 - v.ny * v.ny);
  double left = HUGE_VAL, right = -HUGE_VAL;
  for (int back = 0; back < 2; ++back) {
    const double y = v.cy + (back ? thickness_ * v.ny : 0), rho = back ? back_radius_ : rake_.radius;
    left = std::min(left, y - rho * extent - half * (spread_[back] + rho));
    right = std::max(right, y + rho * extent + half * (spread_[back] + rho));
  }
  return left >= disc_.radius || right <= -disc_.radius;
}

/// Slopes of tangents below the beam's axis: the level one, to either circle, to both. Until `use` returns true.
template <class F> void InsertLines::tangents(const RakeView& v, const F& use) const {
  if (use(0.0)) return;
  const double alpha = 1 - v.ny * v.ny, extent = std::sqrt(alpha), shear = -v.ny * v.nz / alpha;
  for (int back = 0; back < 2; ++back) {
    const double y = v.cy + (back ? thickness_ * v.ny : 0), rho = back ? back_radius_ : rake_.radius;
    const double x = std::clamp(-y / (rho * extent), -0.9999, 0.9999),
                 t = shear + v.nx / alpha * x / std::sqrt(1 - x * x);
    if (std::isfinite(t) && use(t)) return;
  }
  const double share2 = shrink_share_ * shrink_share_, a = v.ny * v.ny - share2, b = v.ny * v.nz,
               c = v.nz * v.nz - share2;
  const double root2 = b * b - a * c;
  if (!(root2 > 0)) return;
  const double far = b + std::copysign(std::sqrt(root2), b);
  for (const double t : {far / a, c / far})
    if (std::isfinite(t) && use(t)) return;
}

double InsertLines::at(double angle) const {
  const RakeView v(rake_, angle);
  if (misses(v, 0)) return -HUGE_VAL;
  double least = HUGE_VAL;
  tangents(v, [&](double t) {
    least = std::min(least, line(v, t, 0, 0));
    return false;
  });
  return least;
}

bool InsertLines::below(double from, double to, double fall, double limit) const {
  const double half = 0.5 * (to - from);
  const RakeView v(rake_, from + half);
  if (misses(v, half)) return true;
  bool proved = false;
  tangents(v, [&](double t) { return proved = line(v, t, half, fall) < limit; });
  return proved;
}

} // namespace gumshoe::models::tool_length
