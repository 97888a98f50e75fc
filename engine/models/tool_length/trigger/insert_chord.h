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
#include "math/lane_functions.h"

namespace gumshoe::models::tool_length {

/// Share of the beam's disc above a line as a function of its height. J(x) = asin x + x sqrt(1 - x^2) is half the disc
/// (of radius 1) minus the part above a line at height x.
struct DiscShare {
  double radius = 0;
  double depth = 0;               ///< height of the level line above which the trigger's share lies, in radii
  double half_chord = 0;          ///< of that line, in radii
  std::array<double, 9> series{}; ///< J(depth + x) - J(depth) = x (series[0] + series[1] x + ...)

  DiscShare(double beam_radius, double fraction);
  /// The line above which the share lies less an area of `more` radii squared, in radii above `depth`; NaN where the
  /// series might not give 1e-16.
  double rise(double more) const {
    const double first = more / series[0];
    if (!(first < 0.1 * (1 - std::fabs(depth)))) return std::nan("");
    double x = first - series[1] / series[0] * first * first;
    for (int i = first > 0.01 ? 0 : 1; i < 2; ++i) {
      double value = 0, slope = 0; // of value x
      for (std::size_t j = series.size(); j-- > 0;) {
        slope = slope * x + value;
        value = value * x + series[j];
      }
      x -= (value * x - more) / (value + slope * x);
    }
    return x;
  }
};

/// The insert's circles in the tool's frame with what is constant in a turn.
struct RakeBody {
  explicit RakeBody(const InsertBody<double>& body);
  InsertBody<double>::Vector centre, normal; ///< of the rake circle; the normal towards the flank
  double radius, yaw, sin_pitch, cos_pitch, side, rise;
};

/// The rake circle on the photodiode plane at one spindle angle, with derivatives by it.
struct RakeView {
  double cy, cz, ny, nz, nx; ///< nx along the beam, its size
  double cy1, cz1, ny1, nz1;
  RakeView(const RakeBody& b, double angle) {
    const auto sc = sine_cosine_lane(Lanes(angle - b.yaw));
    const double s = sc.sine.get(0), c = sc.cosine.get(0);
    cy1 = c * b.centre.x - s * b.centre.y;
    ny1 = c * b.normal.x - s * b.normal.y;
    const double y = s * b.centre.x + c * b.centre.y;
    ny = s * b.normal.x + c * b.normal.y;
    cy = y + b.side;
    cz = b.cos_pitch * b.centre.z - b.sin_pitch * cy1 + b.rise;
    nz = b.cos_pitch * b.normal.z - b.sin_pitch * ny1;
    nx = std::fabs(b.cos_pitch * ny1 + b.sin_pitch * b.normal.z);
    cz1 = b.sin_pitch * y;
    nz1 = b.sin_pitch * ny;
  }
};

/// The chord that the cutting edge cuts from the disc when it covers the share.
struct RakeChord {
  bool solved = false;
  double k = 0;     ///< height on the photodiode plane
  double slope = 0; ///< dk / d(angle)
  double t = 0;     ///< the chord's slope
  double bend = 0;  ///< bound on what p(s) adds to the second derivative of Phi by the angle
};

/// Absolute error below 1e-15 m, times the insert's size in metres if that is more. Not solved where the chord is long
/// compared with the insert, or the insert misses the beam. With `more`, an area: the height at which the share minus
/// that area is covered.
inline RakeChord rake_chord(const RakeView& v, double rho, const DiscShare& disc, double more = 0) {
  RakeChord chord;
  const double beam = disc.radius, alpha = 1 - v.ny * v.ny, extent = rho * std::sqrt(alpha),
               shear = -v.ny * v.nz / alpha;
  const double c0 = beam * disc.half_chord, reach = rho * v.nx;
  // Start: as if ellipse, chord and line were small against each other.
  const double by_reach = 1 / reach, ratio = c0 * by_reach;
  if (!(ratio < 0.3)) return chord;
  double p = beam * disc.depth + c0 * ratio * (1.0 / 3.0);
  const double start = -v.cy / (extent * (1 - 0.5 * ratio * ratio) + p), rest = 1 - start * start;
  if (!(rest > 0.1)) return chord;
  double t = shear + v.nx / alpha * start / std::sqrt(rest);
  for (int pass = 0; pass < 12; ++pass) {
    const double q2 = 1 + t * t, q = std::sqrt(q2), along = t * v.ny - v.nz, g = std::sqrt(q2 - along * along);
    const double by_q = 1 / q, by_g = 1 / g;
    const double c = std::sqrt(beam * beam - p * p), s = c * g * by_q * by_reach, s2 = s * s;
    if (!(s2 < 0.04)) return chord;
    // area of the unit circle's segment: integral of 2 s^2 / sqrt(1 - s^2)
    const double segment =
        s * s2 *
        (2.0 / 3 +
         s2 * (1.0 / 5 + s2 * (3.0 / 28 + s2 * (5.0 / 72 + s2 * (35.0 / 704 +
                                                                 s2 * (63.0 / 1664 +
                                                                       s2 * (231.0 / 7680 + s2 * (429.0 / 17408))))))));
    const double x = disc.rise((rho * reach * segment + more) / (beam * beam));
    const double before = p;
    p = beam * (disc.depth + x);
    const double r = std::sqrt(1 - s2), normal_y = (alpha * t + v.ny * v.nz) * by_g;
    const double off = v.cy + p * t * by_q + r * rho * normal_y; // dPhi/dt
    const double stiff = p * by_q * by_q * by_q + r * reach * v.nx * by_g * by_g * by_g;
    const double step = -off / stiff;
    // Phi is stationary in t and in s: what is left is of the second order in both (third in t, corrected).
    const double chord_change = (p - before) * (p + before) / (2 * c * c),
                 settled = rho * g * s2 * chord_change * chord_change;
    if (!(std::fabs(step) < 0.5 && x == x)) return chord;
    if (std::fabs(step) < 2e-5 && settled < 1e-16) {
      const double c1 = std::sqrt(beam * beam - p * p),
                   area1 = -(v.ny * v.ny1 + v.nz * v.nz1) * rho * reach / (v.nx * v.nx);
      const double drift = segment / (2 * c1), p1 = rho * rho * drift;
      chord.solved = true;
      chord.k = p * q + t * v.cy - v.cz + r * rho * g + 0.5 * off * step;
      // its own change with t over the step that is left, too
      const double along1 = t * v.ny1 - v.nz1;
      const double mixed = v.cy1 + r * rho * (normal_y * along * along1 * by_g - v.ny1 * along - v.ny * along1) * by_g;
      chord.slope = t * v.cy1 - v.cz1 - r * rho * along * along1 * by_g + q * area1 * drift + mixed * step;
      chord.t = t;
      chord.bend = q * (p1 + 4 * std::fabs(p) * p1 * p1 / (c1 * c1));
      return chord;
    }
    t += step;
  }
  return chord;
}

} // namespace gumshoe::models::tool_length
