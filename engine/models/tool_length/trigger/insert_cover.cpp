#include "models/tool_length/trigger/insert_cover.h"

#include <algorithm>
#include <cmath>

namespace gumshoe::models::tool_length {

namespace {

struct Interval {
  double from, to;
};
struct Inside {
  std::array<Interval, 2> interval;
  int size = 0;
  bool full = false;
};

/// Root of f in [lo, hi] with f(lo) <= 0 <= f(hi) (rising) or the reverse; `f` gives value and slope.
template <class F> double safe_root(const F& f, double lo, double hi, bool rising, double start) {
  double x = start;
  if (!(x > std::min(lo, hi) && x < std::max(lo, hi))) x = 0.5 * (lo + hi);
  for (int i = 0; i < 80; ++i) {
    const auto [value, slope] = f(x);
    if (value == 0) return x;
    ((value < 0) == rising ? lo : hi) = x;
    double next = x - value / slope;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (std::fabs(next - x) <= 1e-15 * (1 + std::fabs(x))) return next;
    x = next;
  }
  return x;
}

/// An ellipse along its axes and the beam's disc, seen from the ellipse's centre.
struct Ellipse {
  double a, b; ///< half axes
  double x, z; ///< the beam's axis
  double r2;   ///< of the beam

  /// Distance of a point to the beam's axis squared, less that of the disc.
  double excess(double u) const {
    const double c = a * std::cos(u) - x, n = b * std::sin(u) - z;
    return c * c + n * n - r2;
  }
  /// Where the ellipse crosses the circle between a point inside and one outside.
  double crossing(double from, double to, bool rising) const {
    const auto f = [&](double u) {
      const double c = std::cos(u), n = std::sin(u), dx = a * c - x, dz = b * n - z;
      return std::pair{dx * dx + dz * dz - r2, 2 * (b * c * dz - a * n * dx)};
    };
    // from the deepest point, as if on a parabola
    const double deep = rising ? from : to, v = excess(deep);
    const double c = std::cos(deep), n = std::sin(deep);
    const double bend = a * a * n * n + b * b * c * c - a * c * (a * c - x) - b * n * (b * n - z);
    const double step = bend > 0 ? std::sqrt(-v / bend) : 0;
    return safe_root(f, from, to, rising, rising ? from + step : to - step);
  }
};

struct Stationary {
  std::array<double, 4> at{};
  std::size_t size = 0;
};

/// Stationary points of the distance to the beam's axis, in order, isolated quadrant by quadrant; none where even the
/// nearest point is outside.
Stationary stationary_points(const Ellipse& ellipse) {
  constexpr double right = 0.5 * pi;
  const auto& [a, b, x, z, r2] = ellipse;
  const double ax = a * std::fabs(x), bz = b * std::fabs(z), e = a * a - b * b;
  const double sx = x < 0 ? -1 : 1, sz = z < 0 ? -1 : 1;
  // Quadrants by the signs kx, kz of cos and sin relative to the axis' own; u' in [0, pi/2].
  const auto in_quadrant = [&](double kx, double kz, double lo, double hi, bool rising, double start) {
    const auto f = [&](double u) {
      const double c = std::cos(u), n = std::sin(u);
      return std::pair{-e * n * c + kx * ax * n - kz * bz * c, -e * (c * c - n * n) + kx * ax * c + kz * bz * n};
    };
    const double u = safe_root(f, lo, hi, rising, start);
    return std::atan2(kz * sz * std::sin(u), kx * sx * std::cos(u));
  };
  Stationary out;
  out.at[0] = in_quadrant(1, 1, 0, right, true, std::atan2(a * std::fabs(z), b * std::fabs(x) + 1e-300));
  if (ellipse.excess(out.at[0]) >= 0) return out;
  out.at[1] = in_quadrant(-1, -1, 0, right, false, 0.25 * pi);
  out.size = 2;
  if (ax > 0 || bz > 0) {
    const double t = std::cbrt(bz / ax), ustar = std::isfinite(t) ? std::atan(t) : right;
    const double c = std::cos(ustar), n = std::sin(ustar);
    if (-e * n * c + ax * n + bz * c < 0) {
      out.at[2] = in_quadrant(1, -1, 0, ustar, false, 0.5 * ustar);
      out.at[3] = in_quadrant(1, -1, ustar, right, true, 0.5 * (ustar + right));
      out.size = 4;
    }
  }
  std::sort(out.at.begin(), out.at.begin() + static_cast<std::ptrdiff_t>(out.size));
  return out;
}

/// Where the ellipse runs inside the disc: between stationary points the distance is monotone. @param turned of the
/// ellipse's axes
Inside intervals(const Ellipse& ellipse, double turned) {
  Inside result;
  const auto [at, count] = stationary_points(ellipse);
  if (count == 0) return result;
  std::array<double, 4> value{};
  for (std::size_t i = 0; i < count; ++i) value[i] = ellipse.excess(at[i]);
  std::array<double, 2> enter{}, leave{};
  std::size_t enters = 0, leaves = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = (i + 1) % count;
    const double to = j == 0 ? at[0] + 2 * pi : at[j];
    if (value[i] >= 0 && value[j] < 0 && enters < 2) enter[enters++] = ellipse.crossing(at[i], to, false);
    if (value[i] < 0 && value[j] >= 0 && leaves < 2) leave[leaves++] = ellipse.crossing(at[i], to, true);
  }
  result.full = enters == 0 || enters != leaves;
  if (result.full) return result;
  for (std::size_t i = 0; i < enters; ++i) {
    double to = 1e300; // the next leaving after this entering
    for (std::size_t l = 0; l < leaves; ++l) to = std::min(to, leave[l] + (leave[l] < enter[i] ? 2 * pi : 0));
    result.interval[i] = {enter[i] + turned, to + turned};
  }
  result.size = static_cast<int>(enters);
  return result;
}

/// Where the rake's or the back's ellipse runs inside the disc.
Inside inside_of(const InsertShadow<double>& s, bool back, double k, double beam_radius) {
  const double radius = back ? s.back_radius : s.rake_radius;
  const Planar<double> centre{back ? s.back.y : s.rake.y, (back ? s.back.z : s.rake.z) + k};
  if (radius == 0) return {{}, 0, std::hypot(centre.y, centre.z) < beam_radius};
  const double w0 = 0.5 * std::atan2(2 * dot(s.a, s.b), dot(s.a, s.a) - dot(s.b, s.b));
  const double c0 = std::cos(w0), s0 = std::sin(w0);
  const Planar<double> p{s.a.y * c0 + s.b.y * s0, s.a.z * c0 + s.b.z * s0};
  const double length = std::hypot(p.y, p.z);
  const Planar<double> p1{p.y / length, p.z / length}, q1{-p1.z, p1.y};
  return intervals({radius * length, radius * std::max(0.0, cross(s.a, s.b) / length), -dot(centre, p1),
                    -dot(centre, q1), beam_radius * beam_radius},
                   w0);
}

void add(InsertParts& parts, const InsertPart& p) {
  if (parts.size < static_cast<int>(parts.part.size())) parts.part[static_cast<std::size_t>(parts.size++)] = p;
}

void add_arc(InsertParts& parts, const InsertShadow<double>& s, InsertPiece piece, double from, double to, double k,
             double beam_radius) {
  const Inside in = inside_of(s, piece == InsertPiece::back_arc, k, beam_radius);
  if (in.full) return add(parts, {piece, from, to, false, false});
  std::array<InsertPart, 4> found;
  std::size_t n = 0;
  for (int i = 0; i < in.size; ++i) {
    const Interval v = in.interval[static_cast<std::size_t>(i)];
    const double start = v.from - 2 * pi * std::floor((v.from - from) / (2 * pi)), length = v.to - v.from;
    for (const double first : {start - 2 * pi, start}) {
      const double lo = std::max(first, from), hi = std::min(first + length, to);
      if (lo < hi) found[n++] = {piece, lo, hi, first > from, first + length < to};
    }
  }
  for (std::size_t i = 1; i < n; ++i) // few: by insertion
    for (std::size_t j = i; j > 0 && found[j].from < found[j - 1].from; --j) std::swap(found[j], found[j - 1]);
  for (std::size_t i = 0; i < n; ++i) add(parts, found[i]);
}

void add_line(InsertParts& parts, const InsertShadow<double>& s, InsertPiece piece, double w, double k,
              double beam_radius) {
  const bool to_rake = piece == InsertPiece::to_rake;
  const auto a = insert_point(s, k, to_rake, w), b = insert_point(s, k, !to_rake, w);
  const Planar<double> d{b.y - a.y, b.z - a.z};
  const double dd = dot(d, d), ad = dot(a, d), c = dot(a, a) - beam_radius * beam_radius;
  if (dd == 0) return;
  const double root2 = ad * ad - dd * c;
  if (root2 <= 0) return;
  // the root of larger size first, the other by Vieta
  const double q = -(ad + std::copysign(std::sqrt(root2), ad)), t1 = q / dd, t2 = c / q;
  const double first = std::min(t1, t2), second = std::max(t1, t2);
  const double lo = std::max(first, 0.0), hi = std::min(second, 1.0);
  if (lo < hi) add(parts, {piece, lo, hi, first > 0, second < 1});
}

/// The line between the outermost points across lies in the shadow: above or below the disc with it.
bool lies_above(const InsertShadow<double>& s, double k) {
  const double norm = std::hypot(s.a.y, s.b.y);
  const auto outermost = [&](double sign) {
    const auto point = [&](bool back) {
      const double radius = back ? s.back_radius : s.rake_radius, f = norm > 0 ? sign * radius / norm : 0;
      const Planar<double>& c = back ? s.back : s.rake;
      return Planar<double>{c.y + f * norm * norm, c.z + k + f * (s.a.z * s.a.y + s.b.z * s.b.y)};
    };
    const auto r = point(false), b = point(true);
    return sign * r.y >= sign * b.y ? r : b;
  };
  const auto left = outermost(-1), right = outermost(1);
  const double y = std::clamp(0.0, left.y, std::max(left.y, right.y));
  const double share = right.y > left.y ? (y - left.y) / (right.y - left.y) : 0.5;
  return left.z + share * (right.z - left.z) > 0;
}

} // namespace

bool insert_contains(const InsertShadow<double>& s, double k, const Planar<double>& point) {
  const double det = cross(s.a, s.b), shrink = (s.rake_radius - s.back_radius) * det;
  const Planar<double> d{s.back.y - s.rake.y, s.back.z - s.rake.z};
  const Planar<double> p{point.y - s.rake.y, point.z - s.rake.z - k};
  const double qa = cross(d, s.b), qb = cross(s.a, d), pa = cross(p, s.b), pb = cross(s.a, p);
  const double length = std::hypot(qa, qb);
  double share = 0;
  if (length > shrink) {
    const double along = (pa * qa + pb * qb) / length, off = std::fabs(pa * qb - pb * qa) / length, m = shrink / length;
    share = std::clamp((along - off * m / std::sqrt(1 - m * m)) / length, 0.0, 1.0);
  }
  return std::hypot(pa - share * qa, pb - share * qb) <= s.rake_radius * det - share * shrink;
}

InsertParts insert_parts(const InsertShadow<double>& s, const Joints<double>& j, double k, double beam_radius) {
  InsertParts parts;
  if (!j.back_shows) {
    // One ellipse, closed: its parts may run past a full turn.
    const Inside in = inside_of(s, false, k, beam_radius);
    if (in.full) add(parts, {InsertPiece::rake_arc, 0, 2 * pi, false, false});
    for (int i = 0; i < in.size; ++i) {
      const Interval v = in.interval[static_cast<std::size_t>(i)];
      add(parts, {InsertPiece::rake_arc, v.from, v.to, true, true});
    }
  } else {
    add_arc(parts, s, InsertPiece::back_arc, j.from, j.to, k, beam_radius);
    add_line(parts, s, InsertPiece::to_rake, j.to, k, beam_radius);
    add_arc(parts, s, InsertPiece::rake_arc, j.to, j.from + 2 * pi, k, beam_radius);
    add_line(parts, s, InsertPiece::to_back, j.from, k, beam_radius);
  }
  if (parts.size == 0) {
    parts.whole = insert_contains(s, k, {0, 0});
    if (!parts.whole) parts.above = lies_above(s, k);
    return parts;
  }
  // Rounding at a joint on the circle: a part that ends at a joint needs the next to begin there, else it leaves.
  const auto point = [&](const InsertPart& p, double t) {
    if (p.piece == InsertPiece::back_arc || p.piece == InsertPiece::rake_arc)
      return insert_point(s, k, p.piece == InsertPiece::back_arc, t);
    const bool to_rake = p.piece == InsertPiece::to_rake;
    const auto a = insert_point(s, k, to_rake, to_rake ? j.to : j.from),
               b = insert_point(s, k, !to_rake, to_rake ? j.to : j.from);
    return Planar<double>{a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
  };
  for (int i = 0; i < parts.size; ++i) {
    const std::size_t here = static_cast<std::size_t>(i), next = static_cast<std::size_t>((i + 1) % parts.size);
    InsertPart &p = parts.part[here], &n = parts.part[next];
    const bool follows = j.back_shows ? (static_cast<int>(p.piece) + 1) % 4 == static_cast<int>(n.piece) : here == next;
    if (!p.leaves && !(follows && !n.enters)) p.leaves = true;
    if (p.leaves) {
      const auto end = point(p, p.to);
      const double r = std::hypot(end.y, end.z);
      const double f = -beam_radius / r;
      parts.long_way[here] = insert_contains(s, k, {end.y * f, end.z * f});
    }
  }
  return parts;
}

} // namespace gumshoe::models::tool_length
