#pragma once
/// The height at which a round insert covers the trigger's share, where only the cutting edge's ellipse shows in the
/// beam: in closed form but for two scalars, and a rigorous bound on it at every other spindle angle.
///
/// A line at distance p above the beam's centre with slope t, and an ellipse of which it cuts off a segment: if the
/// line is as high as the disc's share above it plus that segment makes up the trigger's, no higher ellipse covers it.
/// With s the chord's half-length where the ellipse is the unit circle, every (t, s) gives a bound,
///     k <= Phi(t, s, psi) = p(s) sqrt(1 + t^2) + t C_y - C_z + sqrt(1 - s^2) rho g(t),
/// and the least of them is k itself: README.md, "Round inserts, fast".
#include <array>
#include <cmath>

#include "models/tool_length/trigger/insert_shadow.h"
#include "models/tool_length/trigger/selections.h"

namespace gumshoe::models::tool_length {

/// Share of the beam's disc above a line as a function of its height. J(x) = asin x + x sqrt(1 - x^2) is half the disc
/// (of radius 1) minus the part above a line at height x. @tparam V double, or Lanes
template <class V> struct DiscShareOf {
  V radius = V(0.0);
  V depth = V(0.0);          ///< height of the level line above which the trigger's share lies, in radii
  V half_chord = V(0.0);     ///< of that line, in radii
  std::array<V, 9> series{}; ///< J(depth + x) - J(depth) = x (series[0] + series[1] x + ...)

  DiscShareOf(const V& beam_radius, const V& fraction) : radius(beam_radius) {
    // J(sin a) = a + sin a cos a = half a disc less the share
    const V wanted = 0.5 * pi * (1.0 - 2.0 * fraction);
    V a = 0.5 * wanted, sine = V(0.0), cosine = V(1.0);
    auto active = !(wanted == V(0.0));
    if (num::any(active)) {
      a = a * (1.0 + a * a * (1.0 / 3 + a * a * (4.0 / 15)));
      for (int i = 0; i < 60 && num::any(active); ++i) {
        const auto sc = sine_cosine(a);
        V step = -(a + sc.sine * sc.cosine - wanted) / (2.0 * sc.cosine * sc.cosine);
        step = num::select(step > V(-0.2), step, V(-0.2)); // near share 0 and 1 the slope vanishes
        step = num::select(step < V(0.2), step, V(0.2));
        const auto close = num::abs(step) < V(1e-9); // its square is below rounding
        const V s = num::select(close, sc.sine + step * sc.cosine, sc.sine);
        sine = num::select(active, s, sine);
        cosine = num::select(active, num::select(close, sc.cosine - step * s, sc.cosine), cosine);
        active = active && !close;
        a = a + step;
      }
    }
    depth = sine;
    half_chord = cosine;
    // 2 sqrt(1 - (depth + x)^2) in powers of x, integrated
    std::array<V, 9> root{};
    root[0] = cosine;
    for (std::size_t i = 1; i < root.size(); ++i) {
      V sum = i == 1 ? -2.0 * sine : i == 2 ? V(-1.0) : V(0.0);
      for (std::size_t j = 1; j < i; ++j) sum = sum - root[j] * root[i - j];
      root[i] = sum / (2.0 * cosine);
    }
    for (std::size_t i = 0; i < root.size(); ++i) series[i] = 2.0 * root[i] / static_cast<double>(i + 1);
  }
  /// The line above which the share lies less an area of `more` radii squared, in radii above `depth`; NaN where the
  /// series might not give 1e-16.
  V rise(const V& more) const {
    const V first = more / series[0];
    const auto good = first < 0.1 * (1.0 - num::abs(depth));
    V x = first - series[1] / series[0] * first * first;
    const auto improve = [&] {
      V value = V(0.0), slope = V(0.0); // of value x
      for (std::size_t j = series.size(); j-- > 0;) {
        slope = slope * x + value;
        value = value * x + series[j];
      }
      return x - (value * x - more) / (value + slope * x);
    };
    if (const auto large = first > V(0.01); num::any(large)) x = num::select(large, improve(), x);
    return num::select(good, improve(), V(std::nan("")));
  }
};
using DiscShare = DiscShareOf<double>;

/// The insert's circles in the tool's frame with what is constant in a turn.
template <class V> struct RakeBodyOf {
  using Vector = typename InsertBody<V>::Vector;
  explicit RakeBodyOf(const InsertBody<V>& b)
      : centre(b.rake), normal{b.a.z * b.b.y - b.a.y * b.b.z, b.a.x * b.b.z - b.a.z * b.b.x,
                               b.a.y * b.b.x - b.a.x * b.b.y},
        radius(b.rake_radius), yaw(b.yaw), sin_pitch(b.sin_pitch), cos_pitch(b.cos_pitch), side(b.side), rise(b.rise) {}
  Vector centre, normal; ///< of the rake circle; the normal towards the flank
  V radius, yaw, sin_pitch, cos_pitch, side, rise;
};
using RakeBody = RakeBodyOf<double>;

/// In each lane `a` where the mask holds, else `b`; both in one beam.
template <class V> RakeBodyOf<V> select(const Mask<V>& mask, const RakeBodyOf<V>& a, RakeBodyOf<V> b) {
  const auto of = [&](V& x, const V& y) { x = num::select(mask, y, x); };
  of(b.centre.x, a.centre.x), of(b.centre.y, a.centre.y), of(b.centre.z, a.centre.z);
  of(b.normal.x, a.normal.x), of(b.normal.y, a.normal.y), of(b.normal.z, a.normal.z);
  of(b.radius, a.radius), of(b.side, a.side), of(b.rise, a.rise);
  return b;
}

/// The rake circle on the photodiode plane at one spindle angle, with derivatives by it.
template <class V> struct RakeViewOf {
  V cy, cz, ny, nz, nx; ///< nx along the beam, its size
  V cy1, cz1, ny1, nz1;
  RakeViewOf(const RakeBodyOf<V>& b, const V& angle) {
    const auto [s, c] = sine_cosine(V(angle - b.yaw));
    cy1 = c * b.centre.x - s * b.centre.y;
    ny1 = c * b.normal.x - s * b.normal.y;
    const V y = s * b.centre.x + c * b.centre.y;
    ny = s * b.normal.x + c * b.normal.y;
    cy = y + b.side;
    cz = b.cos_pitch * b.centre.z - b.sin_pitch * cy1 + b.rise;
    nz = b.cos_pitch * b.normal.z - b.sin_pitch * ny1;
    nx = num::abs(b.cos_pitch * ny1 + b.sin_pitch * b.normal.z);
    cz1 = b.sin_pitch * y;
    nz1 = b.sin_pitch * ny;
  }
};
using RakeView = RakeViewOf<double>;

/// The chord that the cutting edge cuts from the disc when it covers the share.
template <class V> struct RakeChordOf {
  Mask<V> solved = everywhere<V>(false);
  V k = V(0.0);     ///< height on the photodiode plane
  V slope = V(0.0); ///< dk / d(angle)
  V t = V(0.0);     ///< the chord's slope
  V bend = V(0.0);  ///< bound on what p(s) adds to the second derivative of Phi by the angle
};
using RakeChord = RakeChordOf<double>;

/// Absolute error below 1e-15 m, times the insert's size in metres if that is more. Not solved where the chord is long
/// compared with the insert, or the insert misses the beam. With `more`, an area: the height at which the share minus
/// that area is covered.
template <class V>
RakeChordOf<V> rake_chord(const RakeViewOf<V>& v, const V& rho, const DiscShareOf<V>& disc, const V& more = V(0.0)) {
  RakeChordOf<V> chord;
  const V beam = disc.radius, alpha = 1.0 - v.ny * v.ny, extent = rho * num::sqrt(alpha), shear = -v.ny * v.nz / alpha;
  const V c0 = beam * disc.half_chord, reach = rho * v.nx;
  // Start: as if ellipse, chord and line were small against each other.
  const V by_reach = 1.0 / reach, ratio = c0 * by_reach;
  V p = beam * disc.depth + c0 * ratio * (1.0 / 3.0);
  const V start = -v.cy / (extent * (1.0 - 0.5 * ratio * ratio) + p), rest = 1.0 - start * start;
  auto active = ratio < V(0.3) && rest > V(0.1);
  if (!num::any(active)) return chord;
  V t = shear + v.nx / alpha * start / num::sqrt(rest);
  /// Values at the pass at which a lane has settled.
  struct {
    V t = V(0.0), q = V(1.0), along = V(0.0), g = V(1.0), by_g = V(1.0), r = V(1.0), segment = V(0.0), p = V(0.0),
      normal_y = V(0.0), off = V(0.0), step = V(0.0);
  } at;
  for (int pass = 0; pass < 12; ++pass) {
    const V q2 = 1.0 + t * t, q = num::sqrt(q2), along = t * v.ny - v.nz, g = num::sqrt(q2 - along * along);
    const V by_q = 1.0 / q, by_g = 1.0 / g;
    const V c = num::sqrt(beam * beam - p * p), s = c * g * by_q * by_reach, s2 = s * s;
    // area of the unit circle's segment: integral of 2 s^2 / sqrt(1 - s^2)
    const V segment =
        s * s2 *
        (2.0 / 3 +
         s2 * (1.0 / 5 + s2 * (3.0 / 28 + s2 * (5.0 / 72 + s2 * (35.0 / 704 +
                                                                 s2 * (63.0 / 1664 +
                                                                       s2 * (231.0 / 7680 + s2 * (429.0 / 17408))))))));
    const V x = disc.rise((rho * reach * segment + more) / (beam * beam));
    const V before = p;
    p = beam * (disc.depth + x);
    const V r = num::sqrt(1.0 - s2), normal_y = (alpha * t + v.ny * v.nz) * by_g;
    const V off = v.cy + p * t * by_q + r * rho * normal_y; // dPhi/dt
    const V stiff = p * by_q * by_q * by_q + r * reach * v.nx * by_g * by_g * by_g;
    const V step = -off / stiff;
    // Phi is stationary in t and in s: what is left is of the second order in both (third in t, corrected).
    const V chord_change = (p - before) * (p + before) / (2.0 * c * c),
            settled = rho * g * s2 * chord_change * chord_change;
    active = active && s2 < V(0.04) && num::abs(step) < V(0.5) && x == x;
    const auto close = active && num::abs(step) < V(2e-5) && settled < V(1e-16);
    const auto keep = [&](V& kept, const V& now) { kept = num::select(close, now, kept); };
    keep(at.t, t), keep(at.q, q), keep(at.along, along), keep(at.g, g), keep(at.by_g, by_g), keep(at.r, r);
    keep(at.segment, segment), keep(at.p, p), keep(at.normal_y, normal_y), keep(at.off, off), keep(at.step, step);
    chord.solved = chord.solved || close;
    active = active && !close;
    if (!num::any(active)) break;
    t = t + step;
  }
  if (!num::any(chord.solved)) return chord;
  const V c1 = num::sqrt(beam * beam - at.p * at.p),
          area1 = -(v.ny * v.ny1 + v.nz * v.nz1) * rho * reach / (v.nx * v.nx);
  const V drift = at.segment / (2.0 * c1), p1 = rho * rho * drift;
  chord.k = at.p * at.q + at.t * v.cy - v.cz + at.r * rho * at.g + 0.5 * at.off * at.step;
  // its own change with t over the step that is left, too
  const V along1 = at.t * v.ny1 - v.nz1;
  const V mixed =
      v.cy1 + at.r * rho * (at.normal_y * at.along * along1 * at.by_g - v.ny1 * at.along - v.ny * along1) * at.by_g;
  chord.slope =
      at.t * v.cy1 - v.cz1 - at.r * rho * at.along * along1 * at.by_g + at.q * area1 * drift + mixed * at.step;
  chord.t = at.t;
  chord.bend = at.q * (p1 + 4.0 * num::abs(at.p) * p1 * p1 / (c1 * c1));
  return chord;
}

} // namespace gumshoe::models::tool_length
