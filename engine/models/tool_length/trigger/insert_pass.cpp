#include "models/tool_length/trigger/insert_pass.h"

#include <algorithm>

namespace gumshoe::models::tool_length {

namespace {

double arc_sine(double x) { return num::atan2(x, std::sqrt((1 - x) * (1 + x))); }

} // namespace

InsertPass::InsertPass(const InsertBody<double>& body, const DiscShare& disc)
    : lines_(body, disc), body_(body), disc_(disc) {
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
  const double nz_least = nz_low_ * nz_high_ > 0 ? std::min(std::fabs(nz_low_), std::fabs(nz_high_)) : 0;
  const double g_most = std::sqrt(1 - nz_least * nz_least);
  const double depth = disc_.radius * disc_.depth;
  // Phi at s = 0, t = 0: the level line through the lowest point
  highest_ = depth - body_.rise +
             std::max(tilt_ * spread_ - body_.cos_pitch * c.z + body_.radius * g_most,
                      tilt_ * std::sqrt(body.back.x * body.back.x + body.back.y * body.back.y) -
                          body_.cos_pitch * body.back.z + body.back_radius * g_most);
  blunt_ = body_.radius + std::max(depth, 0.0);
  // y of the lowest point C + radius n_z / g n, n_z / g taken as constant
  const double low = nz_low_ / std::sqrt(1 - nz_low_ * nz_low_), high = nz_high_ / std::sqrt(1 - nz_high_ * nz_high_);
  const double mean = 0.5 * (low + high);
  point_ = mean;
  point_error_ = body_.radius * normal_spread_ * 0.5 * (high - low);
  const double x = c.x + body_.radius * mean * n.x, y = c.y + body_.radius * mean * n.y;
  amplitude_ = std::sqrt(x * x + y * y);
  phase_ = num::atan2(y, x) - body_.yaw;
  const double middle = -body_.side / amplitude_;
  const double angle = middle >= 1 ? 0.5 * pi : middle <= -1 ? -0.5 * pi : arc_sine(middle);
  crest_ = {crest_at(angle - phase_, true), crest_at(pi - angle - phase_, false)};
  const double top = std::max(crest_[0].k, crest_[1].k);
  slack_ = 1.05 * (highest_ - top) + 1e-7;
}

/// The ellipse's lower edge above the beam's axis, less what its bend costs over the disc's chord, about.
InsertPass::Crest InsertPass::crest_at(double angle, bool rises) const {
  const RakeView v(body_, angle);
  const double rho = body_.radius, alpha = 1 - v.ny * v.ny, extent = rho * std::sqrt(alpha), x = v.cy / extent;
  const double g = std::sqrt(1 - v.nz * v.nz), depth = disc_.radius * disc_.depth, c0 = disc_.radius * disc_.half_chord;
  Crest crest{angle, v.cy + rho * point_ * v.ny, -HUGE_VAL, rho * v.nx * v.nx / (g * g * g) + depth, rises};
  if (std::fabs(x) < 1)
    crest.k = depth - v.ny * v.nz / alpha * v.cy - v.cz + rho * rho * v.nx / extent * std::sqrt(1 - x * x) -
              c0 * c0 / (6 * rho * v.nx * v.nx);
  return crest;
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
  if (lo > -1 && hi < 1) {
    const double a = arc_sine(lo), b = arc_sine(hi);
    add(a, b, true);
    add(pi - b, pi - a, false);
    return true;
  }
  if (lo > -1) {
    const double a = arc_sine(lo);
    add(a, pi - a, true);
    return true;
  }
  const double b = arc_sine(hi);
  add(pi - b, 2 * pi + b, false);
  return true;
}

void InsertPass::add(double from, double to, bool rises) {
  Window& w = window_[static_cast<std::size_t>(size_++)];
  w.from = from - phase_ - 1e-12;
  w.to = to - phase_ + 1e-12;
  w.crest = crest_[rises ? 0 : 1];
  const double half = 0.5 * (w.to - w.from), beam = disc_.radius, rho = body_.radius;
  const RakeView v(body_, w.from + half);
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  const double g = std::sqrt(1 - v.nz * v.nz), depth = beam * disc_.depth;
  w.highest = highest_;
  // what tilt makes of the level line's height over the window, from its middle
  const double top = depth - v.cz + rho * g;
  if (tilt_ > 0)
    w.highest = std::min(highest_, top + tilt_ * (spread_ + rho * nz * normal_spread_ / std::sqrt(1 - nz * nz)) * half);
}

InsertPass::Shows InsertPass::shows(double from, double to) const {
  const double half = 0.5 * (to - from), beam = disc_.radius, rho = body_.radius, curl = 0.5 * half * half;
  const RakeView v(body_, from + half);
  const double ny_range = std::fabs(v.ny1) * half + normal_spread_ * curl, ny = std::fabs(v.ny) + ny_range;
  const double along = std::fabs(v.ny1) - std::fabs(v.ny) * half - normal_spread_ * curl;
  const double nx = body_.cos_pitch * along - tilt_ * std::fabs(body_.normal.z);
  if (!(nx > 0.05)) return {};
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  // the lowest point, and the slopes of the edge over |y| <= beam as seen from there: y - y_lowest is at least
  // rho nx^2 t / sqrt(1 + t^2)
  const double y = v.cy + rho * point_ * v.ny, y1 = v.cy1 + rho * point_ * v.ny1;
  const double y_range = std::fabs(y1) * half + amplitude_ * curl + point_error_, stiff = rho * nx * nx;
  const double right = std::max(0.0, beam - y + y_range) / stiff, left = std::max(0.0, beam + y + y_range) / stiff;
  if (!(right < 0.9 && left < 0.9)) return {};
  const double up = right / std::sqrt(1 - right * right), down = left / std::sqrt(1 - left * left);
  const double steep = std::max(up, down), lean = (steep + ny * nz / (nx * nx)) / nx;
  const bool upper_edge_out = nx * rho > beam * (1 + 2 * steep) * std::sqrt(1 + lean * lean);
  const double room = shrink_share_ + nz_low_; // the flank hides where t n_y stays below it
  if (!(upper_edge_out && room > 0)) return {};
  Shows result{v.ny1 > 0 ? 1 : -1, 0};
  // Beyond the slope up to which the flank hides it lies above the cutting edge's tangent there, the edge above that by
  // no more than a parabola.
  const double bent = (1 + steep * steep) * std::sqrt(1 + steep * steep) / stiff;
  const auto beyond = [&](double slope, double reach, double lean_most) {
    if (slope * lean_most < room) return;
    const double hides = room / lean_most, length = stiff * (reach - hides / std::sqrt(1 + hides * hides));
    result.flank += bent * length * length * length / 6;
  };
  beyond(up, right, v.ny + ny_range);
  beyond(down, left, ny_range - v.ny);
  return result;
}

/// Everywhere from `from` to `to` Phi holds, or it is proved that k + fall (angle - from) < limit.
bool InsertPass::cleared(const Window& w, double from, double to, int facing, double fall, double limit) const {
  if (to - from < 0.4) { // wider ones are hardly ever proved at once
    const Shows s = facing != 0 ? shows(from, to) : Shows{};
    if (s.facing == facing && facing != 0 && s.flank == 0) return true;
    if (lines_.below(from, to, fall, limit)) return true;
    // What the flank adds to the area covered it adds at most at every angle.
    if (s.flank > 0 && walk(w, limit + fall * from, fall, 0, from, to, s.flank).found == Found::none) return true;
    if (to - from < 0.01) return false;
  }
  const double middle = 0.5 * (from + to);
  return cleared(w, from, middle, facing, fall, limit) &&
         cleared(w, middle, to, facing, fall, limit - fall * (middle - from));
}

void InsertPass::lower(double margin) {
  for (int i = 0; i < size_; ++i) {
    Window& w = window_[static_cast<std::size_t>(i)];
    const double to = w.crest.k + 0.05 * (w.highest - w.crest.k) + margin;
    if (to < w.highest && first_crossing(w, to, 0, 0, w.from, w.to).found == Found::none) w.highest = to;
  }
}

void InsertPass::lower_far(double far) {
  for (int i = 0; i < size_; ++i) {
    Window& w = window_[static_cast<std::size_t>(i)];
    if (!(w.crest.k < highest_ - far)) continue;
    Top& top = top_[w.crest.rises ? 0 : 1];
    if (!top.tried) top = top_of(w.crest);
    if (top.from <= w.from && w.to <= top.to) w.highest = std::min(w.highest, top.highest);
  }
}

InsertPass::Top InsertPass::top_of(const Crest& crest) const {
  const double deep = highest_ - crest.k;
  Top top{true};
  InsertPass wide(*this); // of no question: what is remembered depends on the geometry alone
  if (!(deep < HUGE_VAL && wide.open(2.2 * deep))) return top;
  for (int i = 0; i < wide.size(); ++i) {
    const Window& w = wide.window(i);
    const double to = crest.k + 0.1 * deep;
    if (w.crest.rises == crest.rises && wide.first_crossing(w, to, 0, 0, w.from, w.to).found == Found::none)
      top.from = w.from, top.to = w.to, top.highest = to;
  }
  return top;
}

InsertPass::Crossing InsertPass::first_crossing(const Window& w, double level, double fall, double shift, double first,
                                                double last) const {
  Crossing found = walk(w, level, fall, shift, first, last);
  const double to = found.found == Found::none ? last : found.turned;
  if (found.found != Found::unproved &&
      !cleared(w, first - shift, to - shift, found.facing, fall, level - fall * first))
    found.found = Found::unproved;
  return found;
}

double InsertPass::curve(const RakeChord& c) const {
  const double nz = std::max(std::fabs(nz_low_), std::fabs(nz_high_));
  const double along = std::fabs(c.t) * normal_spread_ + nz;
  if (!(along < 0.95)) return HUGE_VAL;
  const double carry = spread_ + body_.radius * along * normal_spread_ / std::sqrt(1 - along * along);
  return (std::fabs(c.t) + tilt_) * carry + c.bend;
}

bool InsertPass::below(double from, double to, double fall, double limit) const {
  if (lines_.below(from, to, fall, limit)) return true;
  const double half = 0.5 * (to - from);
  if (half > 0.1) return false;
  const RakeView v(body_, from + half);
  const auto proves = [&](const RakeChord& c) {
    return c.solved && c.k + fall * half + half * (std::fabs(c.slope + fall) + 0.5 * half * curve(c)) < limit;
  };
  if (!proves(rake_chord(v, body_.radius, disc_))) return false;
  const Shows s = shows(from, to);
  return s.facing != 0 && (s.flank == 0 || proves(rake_chord(v, body_.radius, disc_, s.flank)));
}

InsertPass::Crossing InsertPass::walk(const Window& w, double level, double fall, double shift, double first,
                                      double last, double more) const {
  int facing = 0;
  double clear = first; // no crossing before it
  double ahead = last - first;
  // Start before the crest, as on a parabola.
  const double below = w.crest.k - (level - fall * (w.crest.angle + shift));
  double s = w.crest.angle + shift;
  if (below > 0) {
    const double y = std::sqrt(w.crest.y * w.crest.y + 2 * w.crest.blunt * below);
    const double sine = ((w.crest.rises ? -y : y) - body_.side) / amplitude_;
    if (std::fabs(sine) < 1) s = shift - phase_ + (w.crest.rises ? arc_sine(sine) : pi - arc_sine(sine));
  }
  s = std::min(std::max(s, first), last);
  double old_s = s, old_excess = 0, old_rate = 0;
  for (int i = 0; i < 80; ++i) {
    const RakeView v(body_, s - shift);
    const RakeChord c = rake_chord(v, body_.radius, disc_, more);
    const double curve = this->curve(c);
    if (!(c.solved && curve < HUGE_VAL)) {
      // another shape shows here: tangents may lead past
      if (s <= clear) {
        ahead = std::min(2 * ahead, last - clear);
        while (!lines_.below(clear - shift, clear + ahead - shift, fall, level - fall * clear)) {
          if (ahead <= 0.05) return {Found::unproved};
          ahead = std::max(0.5 * ahead, 0.05);
        }
        clear += ahead;
      }
      if (clear >= last) return {Found::none, 0, 0, facing};
      s = clear;
      continue;
    }
    facing = v.ny1 > 0 ? 1 : -1;
    // At d from here the excess is at most excess + rate d + curve d^2 / 2: below zero between the roots.
    const double excess = c.k - (level - fall * s), rate = c.slope + fall, square = rate * rate - 2 * curve * excess;
    if (excess >= 0 && s <= clear) return {s == first ? Found::inside : Found::crossed, s, c.slope, facing};
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
    if (clear >= last) return {Found::none, 0, 0, facing};
    if (!(rate > 0)) {
      s = clear;
      continue;
    }
    // To the root of the cubic through this angle and the one before, whose error is of the fourth order.
    double step = -excess / rate, error = HUGE_VAL;
    if (const double gap = s - old_s; gap != 0) {
      const double chord = (old_excess - excess + rate * gap) / (gap * gap), bend = 0.5 * (rate - old_rate) / gap;
      const double third = 2 * (chord - bend) / gap, second = chord + third * gap;
      if (std::fabs(second * step) < 0.2 * rate && std::fabs(third * step * step) < 0.2 * rate) {
        for (int j = 0; j < 2; ++j)
          step -= (excess + step * (rate + step * (second + step * third))) /
                  (rate + step * (2 * second + step * 3 * third));
        const double both = step * (std::fabs(gap) + std::fabs(step));
        if (fall > 0) error = body_.radius * both * both * fall / rate; // of the level where it is crossed
      }
    }
    old_s = s, old_excess = excess, old_rate = rate;
    if (std::fabs(step) < 1e-7 || error < 1e-16) {
      if (s + step > last) return {Found::none, 0, 0, facing};
      return {Found::crossed, std::max(s + step, first), c.slope, facing};
    }
    s = std::min(std::max(s + step, clear), last);
  }
  return {Found::unproved};
}

} // namespace gumshoe::models::tool_length
