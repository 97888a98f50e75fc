#pragma once
/// Vectors, 3 x 3 matrices and rigid motions in any scalar (double, Lanes, dual numbers). Angles are in rad, lengths in m.
/// A pose is named target_from_source: it converts coordinates of the source frame into those of the target frame, so
/// that a_from_c = a_from_b * b_from_c.
#include "math/scalar.h"

namespace gumshoe {

/// A vector, or a point by its coordinates.
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
template <class T> T length(const Vector3<T>& a) { return num::sqrt(dot(a, a)); }
/// a where the mask holds, else b.
template <class T> Vector3<T> choose(bool first, const Vector3<T>& a, const Vector3<T>& b) { return first ? a : b; }
inline Vector3<Lanes> choose(const Lanes::batch_bool_type& first, const Vector3<Lanes>& a, const Vector3<Lanes>& b) {
  return {xsimd::select(first, a.x, b.x), xsimd::select(first, a.y, b.y), xsimd::select(first, a.z, b.z)};
}
/// The unit vector along a; a must not be the null vector (the result is NaN).
template <class T> Vector3<T> normalised(const Vector3<T>& a) { return T(1.0) / num::sqrt(dot(a, a)) * a; }

/// A 3 x 3 matrix by columns, which are the images of the unit vectors; the unit matrix by default.
template <class T> struct Matrix3 {
  Vector3<T> x{T(1.0), T(0.0), T(0.0)}, y{T(0.0), T(1.0), T(0.0)}, z{T(0.0), T(0.0), T(1.0)};
};
template <class T> Vector3<T> operator*(const Matrix3<T>& m, const Vector3<T>& v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
template <class T> Matrix3<T> operator*(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
/// The transpose, which is the inverse of a rotation.
template <class T> Matrix3<T> transposed(const Matrix3<T>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}

/// A vector or a matrix of numbers, in the scalar T.
template <class T> Vector3<T> constant(const Vector3<double>& v) { return {T(v.x), T(v.y), T(v.z)}; }
template <class T> Matrix3<T> constant(const Matrix3<double>& m) {
  return {constant<T>(m.x), constant<T>(m.y), constant<T>(m.z)};
}

/// Right-handed rotation by `angle` about the unit vector k through the origin: c I + s [k]x + (1 - c) k k' with c, s the
/// cosine and sine (Rodrigues' formula). Orthogonal up to rounding if |k| = 1.
template <class T> Matrix3<T> rotation(const Vector3<T>& k, const T& angle) {
  const T c = num::cos(angle), s = num::sin(angle), v = 1.0 - c;
  return {{c + v * k.x * k.x, v * k.x * k.y + s * k.z, v * k.x * k.z - s * k.y},
          {v * k.x * k.y - s * k.z, c + v * k.y * k.y, v * k.y * k.z + s * k.x},
          {v * k.x * k.z + s * k.y, v * k.y * k.z - s * k.x, c + v * k.z * k.z}};
}
/// The product Rx(a) Ry(b) Rz(c): the meaning given here to three small error angles about X, Y and Z (ISO 230-1). It is
/// smooth at zero, unlike a rotation given by an axis and an angle.
template <class T> Matrix3<T> rotation(const T& a, const T& b, const T& c) {
  const T ca = num::cos(a), sa = num::sin(a), cb = num::cos(b), sb = num::sin(b), cc = num::cos(c), sc = num::sin(c);
  return {{cb * cc, ca * sc + sa * sb * cc, sa * sc - ca * sb * cc},
          {-(cb * sc), ca * cc - sa * sb * sc, sa * cc + ca * sb * sc},
          {sb, -(sa * cb), ca * cb}};
}

/// A rigid motion, x -> turn x + shift; `turn` is orthogonal, `shift` in m.
template <class T> struct Pose {
  Matrix3<T> turn;
  Vector3<T> shift;
};
template <class T> Vector3<T> operator*(const Pose<T>& p, const Vector3<T>& v) { return p.turn * v + p.shift; }
template <class T> Pose<T> operator*(const Pose<T>& a, const Pose<T>& b) { return {a.turn * b.turn, a * b.shift}; }
/// The inverse motion: source_from_target of a target_from_source.
template <class T> Pose<T> inverse(const Pose<T>& p) {
  const Matrix3<T> back = transposed(p.turn);
  return {back, -(back * p.shift)};
}
/// Rotation `turn` about a point (m) that is itself shifted by `travel` (m).
template <class T> Pose<T> about(const Vector3<T>& point, const Matrix3<T>& turn, const Vector3<T>& travel = {}) {
  return {turn, point + travel - turn * point};
}

} // namespace gumshoe
