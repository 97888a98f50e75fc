#pragma once
/// The linearised chain at many poses, on lanes: rows of the least-squares problem of identification.h.
#include <array>
#include <vector>

#include "models/sphere_calibration/sphere_calibration.h"

namespace gumshoe::models::sphere {

/// The seven lengths and the four orientation errors, in the order of the model's quantities: theta.
inline constexpr int unknowns = E_B0C + 1;
static_assert(unknowns == lengths + 4);

/// One reading of the lanes at hand.
template <class T> struct Pose {
  Vector3<T> measured;  ///< t + e - recorded, without squareness: where the probe stood from the origin
  Vector3<T> tip;       ///< at the commanded A
  T B, C, at_B, at_C;   ///< commanded; actual as declared
  T link[4], square[3]; ///< declared; S_XY, S_XZ, S_YZ
  bool squareness = false;
};

template <class T> class PoseRows {
public:
  explicit PoseRows(std::size_t readings) : poses(readings), rows_(3 * readings) {}

  std::vector<Pose<T>> poses;

  /// Of all rows at theta, not whitened: 11 derivatives and the residual, [3 reading + axis][12].
  using Row = std::array<T, unknowns + 1>;
  const std::vector<Row>& linearise(const T* theta) {
    const auto lines = directions(Orientation<T>{theta[E_A0B], theta[E_C0B], theta[E_A0C], theta[E_B0C]});
    const T by_A0B = slope(lines.b.z, lines.b.y), by_C0B = -slope(lines.b.x, lines.b.y);
    const T by_A0C = -slope(lines.c.y, lines.c.z), by_B0C = slope(lines.c.x, lines.c.z);
    const Vector3<T> b_A0B = by_A0B * across(lines.b, {T(0.0), T(0.0), T(1.0)}),
                     b_C0B = by_C0B * across(lines.b, {T(1.0), T(0.0), T(0.0)}),
                     c_A0C = by_A0C * across(lines.c, {T(0.0), T(1.0), T(0.0)}),
                     c_B0C = by_B0C * across(lines.c, {T(1.0), T(0.0), T(0.0)});
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose<T>& pose = poses[i];
      T length[lengths];
      actual(theta, pose, length);
      const Turns<T> turns = exact_turns(lines, pose.at_B, pose.at_C);
      const auto columns = probe_by_lengths(turns);
      const Vector3<T> from_c{length[length_probe_x] - length[length_C_x], -length[length_probe_y] - length[length_C_y],
                              -length[length_probe_z]};
      const Vector3<T> from_b =
          Vector3<T>{length[length_C_x] - length[length_B_x], length[length_C_y], length[length_B_z]} +
          turns.c * from_c;
      for (int j = 0; j < lengths; ++j) put(i, j, columns[static_cast<std::size_t>(j)]);
      put(i, E_A0B, tilted(lines.b, b_A0B, pose.at_B, from_b));
      put(i, E_C0B, tilted(lines.b, b_C0B, pose.at_B, from_b));
      put(i, E_A0C, turns.b * tilted(lines.c, c_A0C, pose.at_C, from_c));
      put(i, E_B0C, turns.b * tilted(lines.c, c_B0C, pose.at_C, from_c));
      put(i, unknowns, pose.measured + square(pose, theta, lines) - sphere::probe_from_origin(length, turns));
      if (pose.squareness)
        for (int j = 0; j < unknowns; ++j) put(i, j, get(i, j) + squared(pose, get(i, j)));
    }
    return rows_;
  }

protected:
  /// Derivative of the slope's tangent, over the length of (slope, slope, 1).
  static T slope(const T& along, const T& main) {
    const T tangent = along / main;
    return (T(1.0) + tangent * tangent) * main;
  }
  /// The part of v across the unit vector k.
  static Vector3<T> across(const Vector3<T>& k, const Vector3<T>& v) { return v - dot(k, v) * k; }
  /// Derivative of rotation(k, angle) v where k moves by dk.
  static Vector3<T> tilted(const Vector3<T>& k, const Vector3<T>& dk, const T& angle, const Vector3<T>& v) {
    const T s = num::sin(angle), versine = T(1.0) - num::cos(angle);
    return s * cross(dk, v) + versine * (dot(k, v) * dk + dot(dk, v) * k);
  }
  static void actual(const T* theta, const Pose<T>& pose, T* length) {
    for (int j = 0; j < lengths; ++j) length[j] = theta[j];
    for (int j = 0; j < 4; ++j) length[length_B_x + j] = length[length_B_x + j] + pose.link[j];
  }
  /// What squareness adds to the recorded commands, of nominal ones.
  static Vector3<T> squared(const Pose<T>& pose, const Vector3<T>& nominal) {
    return {pose.square[1] * nominal.z - pose.square[0] * nominal.y, T(0.0) - pose.square[2] * nominal.z, T(0.0)};
  }
  static Vector3<T> square(const Pose<T>& pose, const T* theta, const Directions<T>& lines) {
    if (!pose.squareness) return {};
    T length[lengths];
    actual(theta, pose, length);
    return squared(pose, pose.tip - sphere::probe_from_origin(length, exact_turns(lines, pose.B, pose.C)));
  }

  std::vector<Row> rows_;

private:
  void put(std::size_t i, int j, const Vector3<T>& v) {
    const auto k = static_cast<std::size_t>(j);
    rows_[3 * i][k] = v.x, rows_[3 * i + 1][k] = v.y, rows_[3 * i + 2][k] = v.z;
  }
  Vector3<T> get(std::size_t i, int j) const {
    const auto k = static_cast<std::size_t>(j);
    return {rows_[3 * i][k], rows_[3 * i + 1][k], rows_[3 * i + 2][k]};
  }
};

} // namespace gumshoe::models::sphere
