#pragma once
/// The parts of a turn in which one insert can trigger, and the walk through them, for doubles and for lanes.
///
/// An insert passes the beam in one or two *windows* of angle: outside them it covers the share at no height above
/// `highest - below`. Inside, where it can be proved that only the cutting edge shows in the beam, the height is that
/// of insert_chord.h, whose bound on every other angle is what the search walks by: nothing is skipped unproved.
#include <array>

#include "models/tool_length/trigger/insert_chord.h"

namespace gumshoe::models::tool_length {

/// Angle at which the lowest point of the cutting edge is nearest to the beam's axis: near the top of a hump of k. For
/// start values.
template <class V> struct CrestOf {
  V angle = V(0.0);
  V y = V(0.0);                         ///< of the lowest point
  V k = V(0.0);                         ///< height k
  V blunt = V(0.0);                     ///< radius of curvature
  Mask<V> rises = everywhere<V>(false); ///< the lowest point comes from the side of -y
};

template <class V> struct WindowOf {
  Mask<V> exists = everywhere<V>(false);
  V from = V(0.0), to = V(0.0); ///< angles
  V highest = V(0.0);           ///< no height k inside is above it
  CrestOf<V> crest;
};

template <class V> CrestOf<V> select(const Mask<V>& mask, const CrestOf<V>& a, const CrestOf<V>& b) {
  return {num::select(mask, a.angle, b.angle), num::select(mask, a.y, b.y), num::select(mask, a.k, b.k),
          num::select(mask, a.blunt, b.blunt), (mask && a.rises) || (!mask && b.rises)};
}

/// How a search in a window ends.
template <class V> struct CrossingOf {
  Mask<V> unproved = everywhere<V>(false), crossed = everywhere<V>(false);
  Mask<V> inside = everywhere<V>(false); ///< crossed at the first angle itself
  V turned = V(0.0);
  V slope = V(0.0);  ///< dk / d(angle) there
  V facing = V(0.0); ///< as ShowsOf
};

/// Part of the insert visible within the beam's width below it, at all angles of an interval.
template <class V> struct ShowsOf {
  V facing = V(0.0); ///< 1 or -1 as the cutting edge's normal points along the beam or against it; 0: nothing proved
  V flank = V(0.0);  ///< area between the cutting edge and the flank below it, at most; 0: only the edge shows
};

/// Wider stretches are hardly ever proved at once, rad.
inline constexpr double widest_stretch = 0.4;

template <class V> class InsertWindows {
public:
  InsertWindows(const InsertBody<V>& body, const DiscShareOf<V>& disc);
  /// The windows for heights k from `highest()` down to `below` less; false where no proof is had.
  Mask<V> open(const V& below);
  /// No height k at any angle is above it.
  const V& highest() const { return highest_; }
  const V& opened() const { return below_; } ///< as open() was last asked
  /// Approximate limit of the distance of a hump's top below `highest()`.
  const V& slack() const { return slack_; }
  const WindowOf<V>& window(int i) const { return window_[static_cast<std::size_t>(i)]; }
  std::array<WindowOf<V>, 2>& windows() { return window_; }
  ShowsOf<V> shows(const V& from, const V& to) const;
  /// Where it is proved that nothing but the cutting edge, `facing` so, shows from `from` to `to`.
  Mask<V> only_edge_shows(const Mask<V>& wanted, V from, const V& to, const V& facing) const;

protected:
  /// The first angle turned from `first` to `last` with k(angle) >= level - fall turned in a window, where the angle is
  /// turned - shift; by Phi alone, of the share less an area `more`. `past(clear, ahead, there)` leads on from `clear`
  /// where another shape shows, or returns false.
  template <class Past>
  CrossingOf<V> walk(const Mask<V>& wanted, const CrestOf<V>& crest, const V& level, const V& fall, const V& shift,
                     const V& first, const V& last, const V& more, const Past& past) const;
  /// Becomes, where `mask`, the other insert in this beam, as far as a walk needs it.
  void take(const Mask<V>& mask, const InsertWindows& other);
  /// Bound on the second derivative of Phi by the angle, in a turn; infinite where there is none.
  V curve(const RakeChordOf<V>& c) const;
  CrestOf<V> crest_at(const V& angle, bool rises) const;

  RakeBodyOf<V> body_;
  DiscShareOf<V> disc_;
  V shrink_share_, spread_, normal_spread_, tilt_;
  V nz_low_, nz_high_, blunt_;
  V highest_, slack_, below_ = V(-1.0);
  V amplitude_, phase_, point_, point_error_;
  std::array<CrestOf<V>, 2> crest_;
  std::array<WindowOf<V>, 2> window_;

private:
  void add(WindowOf<V>& w, const Mask<V>& exists, const V& from, const V& to, const Mask<V>& rises);
};

template <class V>
InsertWindows<V>::InsertWindows(const InsertBody<V>& body, const DiscShareOf<V>& disc) : body_(body), disc_(disc) {
  const V zero(0.0);
  const typename InsertBody<V>::Vector d{body.back.x - body.rake.x, body.back.y - body.rake.y,
                                         body.back.z - body.rake.z};
  const V thickness = num::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), shrink = body.rake_radius - body.back_radius;
  // The flank hides behind the cutting edge in direction w = (t, -1) if w n < shrink_share |w|.
  shrink_share_ = num::select(thickness > zero, shrink / num::sqrt(thickness * thickness + shrink * shrink), V(2.0));
  const auto& c = body_.centre;
  const auto& n = body_.normal;
  spread_ = num::sqrt(c.x * c.x + c.y * c.y);
  normal_spread_ = num::sqrt(n.x * n.x + n.y * n.y);
  tilt_ = num::abs(body_.sin_pitch);
  nz_low_ = body_.cos_pitch * n.z - tilt_ * normal_spread_;
  nz_high_ = body_.cos_pitch * n.z + tilt_ * normal_spread_;
  const V nz_least = num::select(nz_low_ * nz_high_ > zero, smaller(num::abs(nz_low_), num::abs(nz_high_)), zero);
  const V g_most = num::sqrt(1.0 - nz_least * nz_least);
  const V depth = disc_.radius * disc_.depth;
  // Phi at s = 0, t = 0: the level line through the lowest point
  highest_ = depth - body_.rise +
             larger(V(tilt_ * spread_ - body_.cos_pitch * c.z + body_.radius * g_most),
                    V(tilt_ * num::sqrt(body.back.x * body.back.x + body.back.y * body.back.y) -
                      body_.cos_pitch * body.back.z + body.back_radius * g_most));
  blunt_ = body_.radius + larger(depth, zero);
  // y of the lowest point C + radius n_z / g n, n_z / g taken as constant
  const V low = nz_low_ / num::sqrt(1.0 - nz_low_ * nz_low_), high = nz_high_ / num::sqrt(1.0 - nz_high_ * nz_high_);
  const V mean = 0.5 * (low + high);
  point_ = mean;
  point_error_ = body_.radius * normal_spread_ * 0.5 * (high - low);
  const V x = c.x + body_.radius * mean * n.x, y = c.y + body_.radius * mean * n.y;
  amplitude_ = num::sqrt(x * x + y * y);
  phase_ = num::atan2(y, x) - body_.yaw;
  const V middle = -body_.side / amplitude_;
  const V angle =
      num::select(middle >= V(1.0), V(0.5 * pi), num::select(middle <= V(-1.0), V(-0.5 * pi), arc_sine(middle)));
  crest_ = {crest_at(angle - phase_, true), crest_at(pi - angle - phase_, false)};
  const V top = larger(crest_[0].k, crest_[1].k);
  slack_ = 1.05 * (highest_ - top) + 1e-7;
}

/// The ellipse's lower edge above the beam's axis, less what its bend costs over the disc's chord, about.
template <class V> CrestOf<V> InsertWindows<V>::crest_at(const V& angle, bool rises) const {
  const RakeViewOf<V> v(body_, angle);
  const V rho = body_.radius, alpha = 1.0 - v.ny * v.ny, extent = rho * num::sqrt(alpha), x = v.cy / extent;
  const V g = num::sqrt(1.0 - v.nz * v.nz), depth = disc_.radius * disc_.depth, c0 = disc_.radius * disc_.half_chord;
  const V k = depth - v.ny * v.nz / alpha * v.cy - v.cz + rho * rho * v.nx / extent * num::sqrt(1.0 - x * x) -
              c0 * c0 / (6.0 * rho * v.nx * v.nx);
  return {angle, v.cy + rho * point_ * v.ny, num::select(num::abs(x) < V(1.0), k, V(-HUGE_VAL)),
          rho * v.nx * v.nx / (g * g * g) + depth, everywhere<V>(rises)};
}

template <class V> Mask<V> InsertWindows<V>::open(const V& below) {
  below_ = below;
  const V zero(0.0);
  auto proved = nz_low_ > V(-0.9) && nz_high_ < V(0.9) && disc_.half_chord > V(0.3) && below > zero;
  // Lines of slope +-t bound k by highest + D t^2 / 2 +- t y_lowest + radius e t^2 / 2, e = (g^2 / (g - t)^3).
  const V hides = (shrink_share_ + nz_low_) / normal_spread_;
  const V t = smaller(smaller(V(num::sqrt(2.0 * below / blunt_)), V(0.999 * hides)), V(0.3));
  const V nz = larger(num::abs(nz_low_), num::abs(nz_high_)), g = num::sqrt(1.0 - nz * nz), room = g - t;
  proved = proved && t > zero && room > V(0.3);
  const V rounder = body_.radius / (room * room * room) + (blunt_ - body_.radius);
  const V reach = (below + 0.5 * rounder * t * t) / t + point_error_;
  const V lo = (-reach - body_.side) / amplitude_, hi = (reach - body_.side) / amplitude_;
  const auto from_below = lo > V(-1.0), to_above = hi < V(1.0);
  const auto seen = proved && !(lo >= V(1.0) || hi <= V(-1.0)); // else never that high
  proved = proved && !(seen && !from_below && !to_above);
  const V a = arc_sine(lo), b = arc_sine(hi);
  const auto twice = from_below && to_above;
  add(window_[0], seen, num::select(from_below, a, V(pi - b)),
      num::select(twice, b, num::select(from_below, V(pi - a), V(2 * pi + b))), from_below);
  if (num::any(seen && twice))
    add(window_[1], seen && twice, pi - b, pi - a, everywhere<V>(false));
  else
    window_[1].exists = everywhere<V>(false);
  return proved;
}

template <class V>
void InsertWindows<V>::add(WindowOf<V>& w, const Mask<V>& exists, const V& from, const V& to, const Mask<V>& rises) {
  w.exists = exists;
  w.from = from - phase_ - 1e-12;
  w.to = to - phase_ + 1e-12;
  w.crest = select<V>(rises, crest_[0], crest_[1]);
  w.highest = highest_;
  const auto tilted = tilt_ > V(0.0);
  if (!num::any(tilted)) return;
  // what tilt makes of the level line's height over the window, from its middle
  const V half = 0.5 * (w.to - w.from), beam = disc_.radius, rho = body_.radius;
  const RakeViewOf<V> v(body_, V(w.from + half));
  const V nz = larger(num::abs(nz_low_), num::abs(nz_high_));
  const V g = num::sqrt(1.0 - v.nz * v.nz), depth = beam * disc_.depth;
  const V top = depth - v.cz + rho * g;
  const V level = top + tilt_ * (spread_ + rho * nz * normal_spread_ / num::sqrt(1.0 - nz * nz)) * half;
  w.highest = num::select(tilted, smaller(highest_, level), highest_);
}

template <class V> ShowsOf<V> InsertWindows<V>::shows(const V& from, const V& to) const {
  const V zero(0.0), half = 0.5 * (to - from), beam = disc_.radius, rho = body_.radius, curl = 0.5 * half * half;
  const RakeViewOf<V> v(body_, V(from + half));
  const V ny_range = num::abs(v.ny1) * half + normal_spread_ * curl, ny = num::abs(v.ny) + ny_range;
  const V along = num::abs(v.ny1) - num::abs(v.ny) * half - normal_spread_ * curl;
  const V nx = body_.cos_pitch * along - tilt_ * num::abs(body_.normal.z);
  auto proved = nx > V(0.05);
  if (!num::any(proved)) return {};
  const V nz = larger(num::abs(nz_low_), num::abs(nz_high_));
  // the lowest point, and the slopes of the edge over |y| <= beam as seen from there: y - y_lowest is at least
  // rho nx^2 t / sqrt(1 + t^2)
  const V y = v.cy + rho * point_ * v.ny, y1 = v.cy1 + rho * point_ * v.ny1;
  const V y_range = num::abs(y1) * half + amplitude_ * curl + point_error_, stiff = rho * nx * nx;
  const V right = larger(zero, V(beam - y + y_range)) / stiff, left = larger(zero, V(beam + y + y_range)) / stiff;
  proved = proved && right < V(0.9) && left < V(0.9);
  const V up = right / num::sqrt(1.0 - right * right), down = left / num::sqrt(1.0 - left * left);
  const V steep = larger(up, down), lean = (steep + ny * nz / (nx * nx)) / nx;
  const auto upper_edge_out = nx * rho > beam * (1.0 + 2.0 * steep) * num::sqrt(1.0 + lean * lean);
  const V room = shrink_share_ + nz_low_; // the flank hides where t n_y stays below it
  proved = proved && upper_edge_out && room > zero;
  // Beyond the slope up to which the flank hides it lies above the cutting edge's tangent there, the edge above that by
  // no more than a parabola.
  const V bent = (1.0 + steep * steep) * num::sqrt(1.0 + steep * steep) / stiff;
  const auto beyond = [&](const V& slope, const V& reach, const V& lean_most) {
    const V hides = room / lean_most, length = stiff * (reach - hides / num::sqrt(1.0 + hides * hides));
    return num::select(slope * lean_most < room, zero, V(bent * length * length * length / 6.0));
  };
  const V flank = beyond(up, right, V(v.ny + ny_range)) + beyond(down, left, V(ny_range - v.ny));
  return {num::select(proved, num::select(v.ny1 > zero, V(1.0), V(-1.0)), zero), num::select(proved, flank, zero)};
}

template <class V>
Mask<V> InsertWindows<V>::only_edge_shows(const Mask<V>& wanted, V from, const V& to, const V& facing) const {
  const V zero(0.0), width = to - from;
  V step = width / larger(V(1.0), rounded_up(V(width * (1 / widest_stretch))));
  auto proved = wanted && !(width > zero), active = wanted && width > zero && !(facing == zero);
  for (int i = 0; i < 16 && num::any(active); ++i) {
    const V end = num::select(from + 1.5 * step < to, from + step, to);
    const ShowsOf<V> s = shows(from, end);
    const auto good = active && s.facing == facing && s.flank == zero;
    from = num::select(good, end, from);
    step = num::select(good, step, 0.5 * step);
    const auto done = good && end == to;
    proved = proved || done;
    active = active && !done && step > V(0.02);
  }
  return proved;
}

template <class V> void InsertWindows<V>::take(const Mask<V>& mask, const InsertWindows& other) {
  body_ = select<V>(mask, other.body_, body_);
  for (V InsertWindows::*of : {&InsertWindows::shrink_share_, &InsertWindows::spread_, &InsertWindows::normal_spread_,
                               &InsertWindows::nz_low_, &InsertWindows::nz_high_, &InsertWindows::amplitude_,
                               &InsertWindows::phase_, &InsertWindows::point_, &InsertWindows::point_error_})
    this->*of = num::select(mask, other.*of, this->*of);
}

template <class V> V InsertWindows<V>::curve(const RakeChordOf<V>& c) const {
  const V nz = larger(num::abs(nz_low_), num::abs(nz_high_));
  const V along = num::abs(c.t) * normal_spread_ + nz;
  const V carry = spread_ + body_.radius * along * normal_spread_ / num::sqrt(1.0 - along * along);
  return num::select(along < V(0.95), (num::abs(c.t) + tilt_) * carry + c.bend, V(HUGE_VAL));
}

template <class V>
template <class Past>
CrossingOf<V> InsertWindows<V>::walk(const Mask<V>& wanted, const CrestOf<V>& crest, const V& level, const V& fall,
                                     const V& shift, const V& first, const V& last, const V& more,
                                     const Past& past) const {
  const V zero(0.0), one(1.0);
  CrossingOf<V> found;
  auto active = wanted;
  V clear = first; // no crossing before it
  V ahead = last - first;
  // Start before the crest, as on a parabola.
  V s = crest.angle + shift;
  {
    const V below = crest.k - (level - fall * s);
    const V y = num::sqrt(crest.y * crest.y + 2.0 * crest.blunt * below);
    const V sine = (num::select(crest.rises, V(-y), y) - body_.side) / amplitude_, arc = arc_sine(sine);
    s = num::select(below > zero && num::abs(sine) < one, shift - phase_ + num::select(crest.rises, arc, V(pi - arc)),
                    s);
  }
  s = smaller(larger(s, first), last);
  V old_s = s, old_excess = zero, old_rate = zero;
  for (int i = 0; i < 80 && num::any(active); ++i) {
    const RakeViewOf<V> v(body_, V(s - shift));
    const RakeChordOf<V> c = rake_chord(v, body_.radius, disc_, more);
    const V curve = this->curve(c);
    auto other = active && !(c.solved && curve < V(HUGE_VAL));
    if (num::any(other)) { // another shape shows here: tangents may lead past
      const auto stuck = other && s <= clear, lost = stuck && !past(clear, ahead, stuck);
      found.unproved = found.unproved || lost;
      active = active && !lost && !(other && clear >= last);
      s = num::select(other, clear, s);
    }
    const auto seen = active && !other;
    if (!num::any(seen)) continue;
    found.facing = num::select(seen, num::select(v.ny1 > zero, one, V(-1.0)), found.facing);
    // At d from here the excess is at most excess + rate d + curve d^2 / 2: below zero between the roots.
    const V excess = c.k - (level - fall * s), rate = c.slope + fall, square = rate * rate - 2.0 * curve * excess;
    const auto met = seen && excess >= zero && s <= clear;
    const V sum = rate + num::sqrt(square);
    const V back = num::select(curve > zero, V(sum / curve), num::select(rate > zero, V(HUGE_VAL), zero));
    const auto before = seen && !met && ((excess >= zero && !(rate > zero && square > zero)) || s - back > clear);
    auto on = seen && !met && !before;
    clear = num::select(on, larger(clear, V(s - num::select(sum > zero, V(2.0 * excess / sum), V(-HUGE_VAL)))), clear);
    const auto none = on && clear >= last;
    on = on && !none;
    const auto falling = on && !(rate > zero);
    on = on && !falling;
    // To the root of the cubic through this angle and the one before, whose error is of the fourth order.
    V step = -excess / rate, error(HUGE_VAL);
    const V gap = s - old_s;
    if (const auto two = on && !(gap == zero); num::any(two)) {
      const V chord = (old_excess - excess + rate * gap) / (gap * gap), bend = 0.5 * (rate - old_rate) / gap;
      const V third = 2.0 * (chord - bend) / gap, second = chord + third * gap;
      const auto mild = two && num::abs(second * step) < 0.2 * rate && num::abs(third * step * step) < 0.2 * rate;
      V cubic = step;
      for (int j = 0; j < 2; ++j)
        cubic = cubic - (excess + cubic * (rate + cubic * (second + cubic * third))) /
                            (rate + cubic * (2.0 * second + cubic * 3.0 * third));
      step = num::select(mild, cubic, step);
      const V both = step * (num::abs(gap) + num::abs(step));
      // of the level where it is crossed
      error = num::select(mild && fall > zero, V(body_.radius * both * both * fall / rate), error);
    }
    const auto done = on && (num::abs(step) < V(1e-7) || error < V(1e-16));
    const auto there = done && !(s + step > last);
    found.crossed = found.crossed || met || there;
    found.inside = found.inside || (met && s == first);
    found.turned = num::select(met, s, num::select(there, larger(V(s + step), first), found.turned));
    found.slope = num::select(met || there, c.slope, found.slope);
    on = on && !done;
    old_s = num::select(on, s, old_s);
    old_excess = num::select(on, excess, old_excess);
    old_rate = num::select(on, rate, old_rate);
    s = num::select(on, smaller(larger(V(s + step), clear), last), num::select(before || falling, clear, s));
    active = active && !(met || none || done);
  }
  found.unproved = found.unproved || active;
  return found;
}

} // namespace gumshoe::models::tool_length
