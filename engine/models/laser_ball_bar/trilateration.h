#pragma once
/// A point from its distances to three sockets, and back. Frame of the bars: origin in socket 1, x through socket 2,
/// socket 3 at y > 0; the point at z > 0.
///     x = (L1^2 - L2^2 + b^2) / 2b,   y = (L1^2 - L3^2 + x3^2 + y3^2 - 2 x x3) / 2 y3,   z = sqrt(L1^2 - x^2 - y^2)
/// Differences of squares are computed as products, and the base's height by Kahan's order of Heron's formula, so that
/// rounding matters no more than the lengths' own.
/// Source: Schmitz and Ziegert 1999, section 2; Kahan, Miscalculating Area and Angles of a Needle-like Triangle, 2014.
#include <algorithm>

#include "math/dual_order.h"
#include "math/pose.h"

namespace gumshoe::models::laser_ball_bar {

/// Places of the sockets: (0, 0), (b, 0) and (x3, y3), m.
template <class T> struct Sockets {
  T b, x3, y3;
  T b31; ///< distance of sockets 3 and 1
};

/// Twice the area of a triangle over its side a, its height; not positive, or NaN, where the sides make no triangle.
template <class T> T height_of_triangle(const T& a, const T& b, const T& c) {
  // Kahan: with sides large >= middle >= small.
  const T* side[] = {&a, &b, &c};
  std::ranges::sort(side, [](const T* l, const T* r) { return *l > *r; });
  const T &large = *side[0], &middle = *side[1], &small = *side[2];
  const T flat = small - (large - middle);
  if (!(flat > T(0.0))) return T(0.0);
  return 0.5 * num::sqrt((large + (middle + small)) * flat * (small + (large - middle)) * (large + (middle - small))) / a;
}
/// @param b12, b23, b31 distances between the sockets, m; they make a triangle
template <class T> Sockets<T> sockets(const T& b12, const T& b23, const T& b31) {
  return {b12, 0.5 * ((b31 - b23) * ((b31 + b23) / b12) + b12), height_of_triangle(b12, b23, b31), b31};
}

template <class T> struct Distances { T to_1, to_2, to_3; };

/// From the sockets to a point.
template <class T> Vector3<T> from_socket(const Sockets<T>& s, int socket, const Vector3<T>& p) {
  return socket == 0 ? p : Vector3<T>{p.x - (socket == 1 ? s.b : s.x3), socket == 1 ? p.y : p.y - s.y3, p.z};
}

/// The point; its height is NaN where no point has these distances.
template <class T> Vector3<T> trilaterate(const Sockets<T>& s, const Distances<T>& l) {
  const T x = 0.5 * ((l.to_1 - l.to_2) * ((l.to_1 + l.to_2) / s.b) + s.b);
  // x3^2 + y3^2 = b31^2
  const T y = 0.5 * ((l.to_1 - l.to_3) * (l.to_1 + l.to_3) + (s.b31 * s.b31 - 2.0 * (x * s.x3))) / s.y3;
  return {x, y, num::sqrt((l.to_1 - x) * (l.to_1 + x) - y * y)};
}

} // namespace gumshoe::models::laser_ball_bar
