#pragma once
/// Rigorous upper bounds on the height at which an insert of any shape covers the share, over intervals of angle, for
/// doubles and for lanes.
///
/// What is covered lies above every line that touches the shadow from below, so for every slope t the height is at most
///     D sqrt(1 + t^2) + max over both circles of (t C_y - C_z + rho g(t)),
/// with D the height of the line above which the share of the disc lies.
#include "models/tool_length/trigger/insert_chord.h"

namespace gumshoe::models::tool_length {

template <class V> class InsertLines {
public:
  InsertLines(const InsertBody<V>& body, const DiscShareOf<V>& disc);
  /// Height at one angle; minus infinity where the insert misses the beam.
  V at(const V& angle) const;
  /// True, of those wanted, only if k(angle) + fall (angle - from) < limit at all angles from `from` to `to`.
  Mask<V> below(const Mask<V>& wanted, const V& from, const V& to, const V& fall, const V& limit) const;
  /// Becomes, where `mask`, the other.
  void take(const Mask<V>& mask, const InsertLines& other) {
    const auto of = [&](V& x, const V& y) { x = num::select(mask, y, x); };
    rake_ = select<V>(mask, other.rake_, rake_);
    of(back_radius_, other.back_radius_), of(thickness_, other.thickness_), of(shrink_share_, other.shrink_share_);
    of(normal_spread_, other.normal_spread_), of(spread_[0], other.spread_[0]), of(spread_[1], other.spread_[1]);
  }

private:
  Mask<V> misses(const RakeViewOf<V>& v, const V& half) const;
  template <class F> void tangents(const RakeViewOf<V>& v, const Mask<V>& wanted, const F& use) const;
  V line(const RakeViewOf<V>& v, const V& t, const V& half, const V& fall) const;
  RakeBodyOf<V> rake_;
  DiscShareOf<V> disc_;
  V back_radius_, thickness_, shrink_share_, normal_spread_, tilt_, spread_[2];
};

template <class V>
InsertLines<V>::InsertLines(const InsertBody<V>& body, const DiscShareOf<V>& disc)
    : rake_(body), disc_(disc), back_radius_(body.back_radius), tilt_(num::abs(body.sin_pitch)) {
  const auto length = [](const V& x, const V& y, const V& z) { return V(num::sqrt(x * x + y * y + z * z)); };
  const V shrink = body.rake_radius - body.back_radius, zero(0.0);
  thickness_ = length(body.back.x - body.rake.x, body.back.y - body.rake.y, body.back.z - body.rake.z);
  shrink_share_ = shrink / length(thickness_, shrink, zero);
  normal_spread_ = length(rake_.normal.x, rake_.normal.y, zero);
  spread_[0] = length(body.rake.x, body.rake.y, zero);
  spread_[1] = length(body.back.x, body.back.y, zero);
}

/// The line of slope t at the middle of the interval, and what both circles may add to either side.
template <class V> V InsertLines<V>::line(const RakeViewOf<V>& v, const V& t, const V& half, const V& fall) const {
  const V zero(0.0), q2 = 1.0 + t * t, along = t * v.ny - v.nz, along1 = t * v.ny1 - v.nz1;
  const V g = num::sqrt(larger(zero, V(q2 - along * along))), move = num::abs(t) + tilt_;
  // g is the length of a projection of a vector that moves by `move`; smooth while it stays long
  const V far = num::abs(along) + move * half, g_least2 = q2 - far * far;
  V most(-HUGE_VAL);
  for (int back = 0; back < 2; ++back) {
    const V rho = back ? back_radius_ : rake_.radius, aside = back ? thickness_ : zero;
    const V value = t * (v.cy + aside * v.ny) - v.cz - aside * v.nz;
    const V rate = t * (v.cy1 + aside * v.ny1) - v.cz1 - aside * v.nz1 + fall;
    const V turn = 0.5 * move * spread_[back] * half * half;
    const V bound = value + rho * (g + move * half) + num::abs(rate) * half + turn;
    const V bent = 0.5 * rho * far * move * normal_spread_ / num::sqrt(g_least2) * half * half;
    const V smooth = value + rho * g + num::abs(rate - rho * along * along1 / g) * half + turn + bent;
    most = larger(most, num::select(g_least2 > zero, smaller(bound, smooth), bound));
  }
  return most + disc_.radius * disc_.depth * num::sqrt(q2) + fall * half;
}

/// Whether the whole insert misses the beam.
template <class V> Mask<V> InsertLines<V>::misses(const RakeViewOf<V>& v, const V& half) const {
  const V extent = num::sqrt(1.0 - v.ny * v.ny);
  V left(HUGE_VAL), right(-HUGE_VAL);
  for (int back = 0; back < 2; ++back) {
    const V y = back ? V(v.cy + thickness_ * v.ny) : v.cy, rho = back ? back_radius_ : rake_.radius;
    left = smaller(left, V(y - rho * extent - half * (spread_[back] + rho)));
    right = larger(right, V(y + rho * extent + half * (spread_[back] + rho)));
  }
  return left >= disc_.radius || right <= -disc_.radius;
}

/// Slopes of tangents below the beam's axis: the level one, to either circle, to both. `use(t, where)` returns where no
/// more are wanted.
template <class V>
template <class F>
void InsertLines<V>::tangents(const RakeViewOf<V>& v, const Mask<V>& wanted, const F& use) const {
  auto active = wanted;
  const auto offer = [&](const V& t, const Mask<V>& there) {
    const auto where = active && there && num::abs(t) < V(HUGE_VAL);
    if (num::any(where)) active = active && !use(t, where);
    return num::any(active);
  };
  const auto all = everywhere<V>(true);
  if (!offer(V(0.0), all)) return;
  const V one(1.0), alpha = one - v.ny * v.ny, extent = num::sqrt(alpha), shear = -(v.ny * v.nz) / alpha;
  for (int back = 0; back < 2; ++back) {
    const V y = back ? V(v.cy + thickness_ * v.ny) : v.cy, rho = back ? back_radius_ : rake_.radius;
    const V x = smaller(larger(V(-y / (rho * extent)), V(-0.9999)), V(0.9999));
    if (!offer(V(shear + v.nx / alpha * x / num::sqrt(one - x * x)), all)) return;
  }
  const V share2 = shrink_share_ * shrink_share_, a = v.ny * v.ny - share2, b = v.ny * v.nz, c = v.nz * v.nz - share2;
  const V root2 = b * b - a * c, zero(0.0);
  const auto real = root2 > zero;
  if (!num::any(active && real)) return;
  const V root = num::sqrt(num::select(real, root2, zero)), far = b + num::select(b < zero, V(-root), root);
  if (offer(V(far / a), real)) offer(V(c / far), real);
}

template <class V> V InsertLines<V>::at(const V& angle) const {
  const RakeViewOf<V> v(rake_, angle);
  const V zero(0.0), infinite(HUGE_VAL);
  const auto missed = misses(v, zero);
  V least = infinite;
  tangents(v, !missed, [&](const V& t, const Mask<V>& where) {
    least = num::select(where, smaller(least, line(v, t, zero, zero)), least);
    return everywhere<V>(false);
  });
  return num::select(missed, V(-infinite), least);
}

template <class V>
Mask<V> InsertLines<V>::below(const Mask<V>& wanted, const V& from, const V& to, const V& fall, const V& limit) const {
  const V half = 0.5 * (to - from);
  const RakeViewOf<V> v(rake_, V(from + half));
  auto proved = wanted && misses(v, half);
  tangents(v, wanted && !proved, [&](const V& t, const Mask<V>& where) {
    const auto now = where && line(v, t, half, fall) < limit;
    proved = proved || now;
    return now;
  });
  return proved;
}

} // namespace gumshoe::models::tool_length
