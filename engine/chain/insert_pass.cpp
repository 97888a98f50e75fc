#include "chain/insert_pass.h"

#include <algorithm>

namespace gumshoe::chain {

namespace {

constexpr double pi = 3.14159265358979323846;

double arc_sine(double x) { return num::atan2(x, std::sqrt((1 - x) * (1 + x))); }

} // namespace

InsertPass::InsertPass(const InsertBody<double>& body, const DiscShare& disc) : body_(body), disc_(disc) {
  const InsertBody<double>::Vector d{body.back.x - body.rake.x, body.back.y - body.rake.y, body.back.z - body.rake.z};
  const double thickness = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), shrink = body.rake_radius - body.back_radius;
  // The flank hides behind the cutting edge in direction w = (t, -1) if w n < shrink_share |w|.
  shrink_share_ = thickness > 0 ? shrink / std::sqrt(thickness * thickness + shrink * shrink) : 2.0;
  const auto& c = body_.centre;
  const auto& n = body_.normal;
  spread_ = std::sqrt(c.x * c.x + c.y * c.y);
  normal_spread_ = std::sqrt(n.x * n.x + n.y * n.y);
  tilt_ = std::fabs(body_.sin_pitch);
  nz_low_ = body_.cos_pitch * n.z - tilt_ * normal_spread_;
  nz_high_ = body_.cos_pitch * n.z + tilt_ * normal_spread_;
  const double nz_most = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  const double nz_least = nz_low_ * nz_high_ > 0 ? std::min(std::fabs(nz_low_), std::fabs(nz_high_)) : 0;
  const double g_most = std::sqrt(1 - nz_least * nz_least), g_least = std::sqrt(1 - nz_most * nz_most);
  const double depth = disc_.radius * disc_.depth;
  // Phi at s = 0, t = 0: the level line through the lowest point
  highest_ = depth - body_.cos_pitch * c.z - body_.rise + tilt_ * spread_ + body_.radius * g_most;
  slack_ = 2 * tilt_ * spread_ + body_.radius * (g_most - g_least) + disc_.radius * disc_.radius / body_.radius;
  blunt_ = body_.radius + std::max(depth, 0.0);
  // y of the lowest point C + radius n_z / g n, n_z / g taken as constant
  const double low = nz_low_ / std::sqrt(1 - nz_low_ * nz_low_), high = nz_high_ / std::sqrt(1 - nz_high_ * nz_high_);
  const double mean = 0.5 * (low + high);
  point_ = mean;
  point_error_ = body_.radius * normal_spread_ * 0.5 * (high - low);
  const double x = c.x + body_.radius * mean * n.x, y = c.y + body_.radius * mean * n.y;
  amplitude_ = std::sqrt(x * x + y * y);
  phase_ = num::atan2(y, x) - body_.yaw;
}

bool InsertPass::open(double below) {
  below_ = below;
  size_ = 0;
  if (!(nz_low_ > -0.9 && nz_high_ < 0.9 && disc_.half_chord > 0.3 && below > 0)) return false;
  // Lines of slope +-t bound k by highest + D t^2 / 2 +- t y_lowest + radius e t^2 / 2, e = (g^2 / (g - t)^3).
  const double hides = (shrink_share_ + nz_low_) / normal_spread_;
  const double t = std::min({std::sqrt(2 * below / blunt_), 0.999 * hides, 0.3});
  if (!(t > 0)) return false;
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_)), g = std::sqrt(1 - nz * nz), room = g - t;
  if (!(room > 0.3)) return false;
  const double rounder = body_.radius / (room * room * room) + (blunt_ - body_.radius);
  const double reach = (below + 0.5 * rounder * t * t) / t + point_error_;
  const double lo = (-reach - body_.side) / amplitude_, hi = (reach - body_.side) / amplitude_;
  if (lo >= 1 || hi <= -1) return true; // never that high
  if (lo <= -1 && hi >= 1) return false;
  const double middle = -body_.side / amplitude_;
  const double crest = middle >= 1 ? 0.5 * pi : middle <= -1 ? -0.5 * pi : arc_sine(middle);
  if (lo > -1 && hi < 1) {
    const double a = arc_sine(lo), b = arc_sine(hi);
    add(a, b, crest, true);
    add(pi - b, pi - a, pi - crest, false);
    return true;
  }
  if (lo > -1) {
    const double a = arc_sine(lo);
    add(a, pi - a, crest, true);
    return true;
  }
  const double b = arc_sine(hi);
  add(pi - b, 2 * pi + b, pi - crest, false);
  return true;
}

void InsertPass::add(double from, double to, double crest, bool rises) {
  PassWindow& w = window_[static_cast<std::size_t>(size_++)];
  w.from = from - phase_ - 1e-12;
  w.to = to - phase_ + 1e-12;
  w.crest = crest - phase_;
  w.rises = rises;
  const double half = 0.5 * (w.to - w.from), beam = disc_.radius, rho = body_.radius;
  const RakeView v(body_, w.from + half);
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  const double g = std::sqrt(1 - v.nz * v.nz), depth = beam * disc_.depth;
  w.highest = highest_;
  // what tilt makes of the level line's height over the window, from its middle
  const double top = depth - v.cz + rho * g;
  if (tilt_ > 0)
    w.highest = std::min(highest_, top + tilt_ * (spread_ + rho * nz * normal_spread_ / std::sqrt(1 - nz * nz)) * half);
  const RakeView c(body_, w.crest);
  const double c0 = beam * disc_.half_chord, gc = std::sqrt(1 - c.nz * c.nz);
  w.blunt = rho * c.nx * c.nx / (gc * gc * gc) + depth;
  w.crest_y = c.cy + rho * point_ * c.ny;
  w.crest_k = depth - c.cz + rho * gc - w.crest_y * w.crest_y / (2 * w.blunt) - c0 * c0 / (6 * rho * c.nx * c.nx);
}

/// Bounds from the middle of the interval; halved where they do not suffice.
bool InsertPass::only_edge(double from, double to) const {
  const double half = 0.5 * (to - from), beam = disc_.radius, rho = body_.radius, curl = 0.5 * half * half;
  const RakeView v(body_, from + half);
  const double ny_range = std::fabs(v.ny1) * half + normal_spread_ * curl, ny = std::fabs(v.ny) + ny_range;
  const double along = std::fabs(v.ny1) - std::fabs(v.ny) * half - normal_spread_ * curl;
  const double nx = body_.cos_pitch * along - tilt_ * std::fabs(body_.normal.z);
  if (nx > 0.05) {
    // the lowest point, and the slopes of the edge over |y| <= beam as seen from there: y - y_lowest is at least
    // rho nx^2 t / sqrt(1 + t^2)
    const double y = v.cy + rho * point_ * v.ny, y1 = v.cy1 + rho * point_ * v.ny1;
    const double y_range = std::fabs(y1) * half + amplitude_ * curl + point_error_, stiff = rho * nx * nx;
    const double right = (beam - y + y_range) / stiff, left = (beam + y + y_range) / stiff;
    if (right < 0.9 && left < 0.9) {
      const double up = right / std::sqrt(1 - right * right), down = -left / std::sqrt(1 - left * left);
      const double low = v.ny - ny_range, high = v.ny + ny_range;
      const double most = std::max({up * low, up * high, down * low, down * high});
      const double steep = std::max(std::fabs(up), std::fabs(down)), lean = (steep + ny) / nx;
      const bool flank_hides = most - nz_low_ < shrink_share_;
      const bool upper_edge_out = nx * rho > beam * (1 + 2 * steep) * std::sqrt(1 + lean * lean);
      if (flank_hides && upper_edge_out) return true;
    }
  }
  if (half < 0.01) return false;
  return only_edge(from, from + half) && only_edge(from + half, to);
}

InsertPass::Crossing InsertPass::first_crossing(const PassWindow& w, double level, double fall, double shift,
                                                double first, double last) const {
  Crossing found = walk(w, level, fall, shift, first, last);
  const double to = found.found == Found::none ? last : found.turned;
  if (found.found != Found::unproved && !only_edge(first - shift, to - shift)) found.found = Found::unproved;
  return found;
}

InsertPass::Crossing InsertPass::walk(const PassWindow& w, double level, double fall, double shift, double first,
                                      double last) const {
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  double clear = first; // no crossing before it
  // Start before the crest, as on a parabola.
  const double below = w.crest_k - (level - fall * (w.crest + shift));
  double s = w.crest + shift;
  if (below > 0) {
    const double y = std::sqrt(w.crest_y * w.crest_y + 2 * w.blunt * below);
    const double sine = ((w.rises ? -y : y) - body_.side) / amplitude_;
    if (std::fabs(sine) < 1) s = shift - phase_ + (w.rises ? arc_sine(sine) : pi - arc_sine(sine));
  }
  s = std::min(std::max(s, first), last);
  double before_s = s, before_rate = 0;
  for (int i = 0; i < 80; ++i) {
    const RakeChord c = rake_chord(RakeView(body_, s - shift), body_.radius, disc_);
    if (!c.solved) return {Found::unproved};
    const double along = std::fabs(c.t) * normal_spread_ + nz;
    if (!(along < 0.95)) return {Found::unproved};
    const double carry = spread_ + body_.radius * along * normal_spread_ / std::sqrt(1 - along * along);
    const double curve = (std::fabs(c.t) + tilt_) * carry + c.bend;
    // At d from here the excess is at most excess + rate d + curve d^2 / 2: below zero between the roots.
    const double excess = c.k - (level - fall * s), rate = c.slope + fall, square = rate * rate - 2 * curve * excess;
    if (excess >= 0 && s <= clear) return {s == first ? Found::inside : Found::crossed, s, c.slope};
    if (excess >= 0 && !(rate > 0 && square > 0)) {
      s = clear;
      continue;
    }
    const double sum = rate + std::sqrt(square);
    if (s - (curve > 0 ? sum / curve : rate > 0 ? HUGE_VAL : 0) > clear) {
      s = clear;
      continue;
    }
    clear = std::max(clear, s - (sum > 0 ? 2 * excess / sum : -HUGE_VAL));
    if (clear >= last) return {};
    if (!(rate > 0)) {
      s = clear;
      continue;
    }
    // Newton's step, with the bend seen since the last angle: its error is of the third order.
    const double step = -excess / rate, bend = s != before_s ? (before_rate - rate) / (s - before_s) : HUGE_VAL;
    const double second = 0.5 * bend * step * step / rate;
    before_s = s, before_rate = rate;
    if (std::fabs(step) < 1e-7 || (std::fabs(second) < 1e-8 && fall * std::fabs(second) < 1e-13)) {
      const double end = s + step + (bend < HUGE_VAL ? second : 0);
      if (end > last) return {};
      return {Found::crossed, std::max(end, clear), c.slope};
    }
    s += step + (std::fabs(second) < 0.3 * std::fabs(step) ? second : 0);
    s = std::min(std::max(s, clear), last);
  }
  return {Found::unproved};
}

} // namespace gumshoe::chain
