#pragma once
/// Vectors, 3 x 3 matrices and rigid motions in any scalar (double, Lanes, dual numbers). A pose is named
/// target_from_source: it turns coordinates of the source frame into those of the target.
#include "math/scalar.h"

namespace gumshoe {

template <class T> struct Vector3 { T x = T(0.0), y = T(0.0), z = T(0.0); };
template <class T> Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> Vector3<T> operator-(const Vector3<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> Vector3<T> operator*(const T& s, const Vector3<T>& a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> T dot(const Vector3<T>& a, const Vector3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Not for the null vector.
template <class T> Vector3<T> normalised(const Vector3<T>& a) { return T(1.0) / num::sqrt(dot(a, a)) * a; }

/// By columns: the images of the unit vectors.
template <class T> struct Matrix3 {
  Vector3<T> x{T(1.0), T(0.0), T(0.0)}, y{T(0.0), T(1.0), T(0.0)}, z{T(0.0), T(0.0), T(1.0)};
};
template <class T> Vector3<T> operator*(const Matrix3<T>& m, const Vector3<T>& v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
template <class T> Matrix3<T> operator*(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class T> Matrix3<T> transposed(const Matrix3<T>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}

/// Right-handed rotation about a unit vector k through the origin, exact (Rodrigues): c I + s [k]x + (1 - c) k k'.
template <class T> Matrix3<T> rotation(const Vector3<T>& k, const T& angle) {
  const T c = num::cos(angle), s = num::sin(angle), v = 1.0 - c;
  return {{c + v * k.x * k.x, v * k.x * k.y + s * k.z, v * k.x * k.z - s * k.y},
          {v * k.x * k.y - s * k.z, c + v * k.y * k.y, v * k.y * k.z + s * k.x},
          {v * k.x * k.z + s * k.y, v * k.y * k.z - s * k.x, c + v * k.z * k.z}};
}
/// Exact rotations about X, Y and Z one after the other, Rx(a) Ry(b) Rz(c): what three small angles mean. Smooth at
/// zero, where an angle and an axis are not.
template <class T> Matrix3<T> rotation(const T& a, const T& b, const T& c) {
  const T ca = num::cos(a), sa = num::sin(a), cb = num::cos(b), sb = num::sin(b), cc = num::cos(c), sc = num::sin(c);
  return {{cb * cc, ca * sc + sa * sb * cc, sa * sc - ca * sb * cc},
          {-(cb * sc), ca * cc - sa * sb * sc, sa * cc + ca * sb * sc},
          {sb, -(sa * cb), ca * cb}};
}

/// A rigid motion: x -> turn x + shift.
template <class T> struct Pose {
  Matrix3<T> turn;
  Vector3<T> shift;
};
template <class T> Vector3<T> operator*(const Pose<T>& p, const Vector3<T>& v) { return p.turn * v + p.shift; }
template <class T> Pose<T> operator*(const Pose<T>& a, const Pose<T>& b) { return {a.turn * b.turn, a * b.shift}; }
template <class T> Pose<T> inverse(const Pose<T>& p) {
  const Matrix3<T> back = transposed(p.turn);
  return {back, -(back * p.shift)};
}
/// Turns about a point, which itself moves on by `travel`.
template <class T> Pose<T> about(const Vector3<T>& point, const Matrix3<T>& turn, const Vector3<T>& travel = {}) {
  return {turn, point + travel - turn * point};
}

} // namespace gumshoe
