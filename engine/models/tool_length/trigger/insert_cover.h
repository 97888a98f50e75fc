#pragma once
/// Area of the beam's disc that an insert's shadow covers: in closed form, given the crossings of outline and circle.
///
/// The outline runs counter-clockwise over an arc of the back ellipse, a straight line, an arc of the rake ellipse and
/// a straight line back. Both ellipses have one shape, so a line touches both at equal w.
#include <array>

#include "models/tool_length/trigger/insert_shadow.h"

namespace gumshoe::models::tool_length {

enum class InsertPiece { back_arc, to_rake, rake_arc, to_back };

/// A part of the outline inside the disc; the parameter is w on an arc, 0 to 1 on a line.
struct InsertPart {
  InsertPiece piece;
  double from, to;
  bool enters, leaves; ///< crosses the circle there; else the piece begins or ends
};
struct InsertParts {
  std::array<InsertPart, 12> part;
  int size = 0;
  bool whole = false;              ///< no part: the disc lies inside the shadow
  bool above = false;              ///< no part, not whole: the shadow lies above the disc
  std::array<bool, 12> long_way{}; ///< after part i: the circle's arc is nearly a full turn, not nearly none
};

/// Where the two lines touch: the back ellipse is on the outline from `from` to `to`.
template <class T> struct Joints {
  bool back_shows = false;
  T from = T(0.0), to = T(0.0);
};
/// Without tangents (one ellipse lies within the other) the outline is the rake ellipse alone.
template <class T> Joints<T> joints(const InsertShadow<T>& s) {
  const Planar<T> d{s.back.y - s.rake.y, s.back.z - s.rake.z};
  const T qa = cross(d, s.b), qb = cross(s.a, d); // the offset in the ellipses' own coordinates, times a x b
  const T length = num::sqrt(qa * qa + qb * qb), shrink = (s.rake_radius - s.back_radius) * cross(s.a, s.b);
  Joints<T> j;
  if (!(num::value(length) > num::value(shrink))) return j;
  const T m = shrink / length, n = num::sqrt(1.0 - m * m), ua = qa / length, ub = qb / length;
  j.back_shows = true;
  j.from = num::atan2(m * ub - n * ua, m * ua + n * ub);
  j.to = num::atan2(m * ub + n * ua, m * ua - n * ub);
  if (num::value(j.to) < num::value(j.from)) j.to = j.to + 2 * pi;
  return j;
}

/// The parts inside the disc of radius `beam_radius` about the origin, the shadow raised by k.
InsertParts insert_parts(const InsertShadow<double>& shadow, const Joints<double>& joints, double k,
                         double beam_radius);

/// The point of the rake ellipse, or of the back ellipse, at parameter w (rad), the shadow raised by k (m).
template <class T> Planar<T> insert_point(const InsertShadow<T>& s, const T& k, bool back, const T& w) {
  const T c = num::cos(w), n = num::sin(w);
  const T radius = back ? s.back_radius : s.rake_radius;
  const Planar<T>& centre = back ? s.back : s.rake;
  return {centre.y + radius * (s.a.y * c + s.b.y * n), centre.z + k + radius * (s.a.z * c + s.b.z * n)};
}

template <class T> struct InsertCover {
  T area;
  T slope; ///< d(area)/dk
};

/// Area of the disc covered. For dual numbers the crossings take `derivative_levels - 1` Newton steps: an error of the
/// crossings is of second order in the area.
template <class T>
InsertCover<T> insert_cover(const InsertShadow<T>& s, const Joints<T>& j, const T& k, const T& beam_radius,
                            const InsertParts& parts) {
  if (parts.size == 0) return {parts.whole ? pi * (beam_radius * beam_radius) : T(0.0), T(0.0)};
  std::array<Planar<T>, 12> first, last;
  T twice = T(0.0), advance = T(0.0);
  for (int i = 0; i < parts.size; ++i) {
    const InsertPart& p = parts.part[static_cast<std::size_t>(i)];
    Planar<T>&begin = first[static_cast<std::size_t>(i)], &end = last[static_cast<std::size_t>(i)];
    if (p.piece == InsertPiece::to_rake || p.piece == InsertPiece::to_back) {
      const bool to_rake = p.piece == InsertPiece::to_rake;
      const T& w = to_rake ? j.to : j.from;
      const Planar<T> a = insert_point(s, k, to_rake, w), b = insert_point(s, k, !to_rake, w);
      const Planar<T> d{b.y - a.y, b.z - a.z};
      const auto at = [&](double t0, bool crosses) {
        T t(t0);
        for (int level = 1; crosses && level < num::derivative_levels<T>; ++level) {
          const Planar<T> x{a.y + t * d.y, a.z + t * d.z};
          t = t - (dot(x, x) - beam_radius * beam_radius) / (2.0 * dot(x, d));
        }
        return Planar<T>{a.y + t * d.y, a.z + t * d.z};
      };
      begin = at(p.from, p.enters);
      end = at(p.to, p.leaves);
      twice = twice + cross(begin, end);
    } else {
      const bool back = p.piece == InsertPiece::back_arc;
      const T radius = back ? s.back_radius : s.rake_radius;
      // An end of the piece is where a line touches; of the rake arc: from j.to to j.from, a turn later.
      const auto at = [&](double w0, bool crosses, bool start) {
        T w(w0);
        if (!crosses && j.back_shows) {
          w = start == back ? j.from : j.to;
          w = w + 2 * pi * std::round((w0 - num::value(w)) / (2 * pi));
        }
        for (int level = 1; crosses && level < num::derivative_levels<T>; ++level) {
          const Planar<T> x = insert_point(s, k, back, w);
          const T c = num::cos(w), n = num::sin(w);
          const Planar<T> d{radius * (s.b.y * c - s.a.y * n), radius * (s.b.z * c - s.a.z * n)};
          w = w - (dot(x, x) - beam_radius * beam_radius) / (2.0 * dot(x, d));
        }
        return w;
      };
      const T from = at(p.from, p.enters, true), to = at(p.to, p.leaves, false);
      begin = insert_point(s, k, back, from);
      end = insert_point(s, k, back, to);
      const Planar<T> centre{back ? s.back.y : s.rake.y, (back ? s.back.z : s.rake.z) + k};
      const Planar<T> chord{end.y - begin.y, end.z - begin.z};
      twice = twice + radius * radius * cross(s.a, s.b) * (to - from) + cross(centre, chord);
    }
    advance = advance + (end.y - begin.y);
  }
  for (int i = 0; i < parts.size; ++i) {
    const std::size_t here = static_cast<std::size_t>(i), next = static_cast<std::size_t>((i + 1) % parts.size);
    if (!parts.part[here].leaves) continue;
    const T turn = num::atan2(cross(last[here], first[next]), dot(last[here], first[next]));
    const double t = num::value(turn);
    const bool near_zero = std::fabs(t) < 1e-9;
    const bool add = near_zero ? parts.long_way[here] && t <= 0 : t < 0;
    twice = twice + beam_radius * beam_radius * (add ? turn + 2 * pi : turn);
  }
  return {0.5 * twice, -advance};
}

/// True if the shadow, raised by k, contains the point.
bool insert_contains(const InsertShadow<double>& shadow, double k, const Planar<double>& point);

} // namespace gumshoe::models::tool_length
