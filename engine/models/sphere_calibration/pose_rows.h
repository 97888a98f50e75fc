#pragma once
/// The linearised chain at many poses, on lanes: rows of the least-squares problem of identification.h.
#include <array>
#include <vector>

#include "models/sphere_calibration/contact.h"

namespace gumshoe::models::sphere_calibration {

/// The seven lengths and the four orientation errors, in the order of the model's quantities: theta.
inline constexpr int unknowns = Q::E_B0C + 1;
static_assert(unknowns == lengths + 4);

/// One reading.
template <class T> struct Pose {
  const At<T>* at;     ///< as declared
  Vector3<T> measured; ///< t + e - recorded, without squareness: where the probe stood from the origin
  Vector3<T> tip;      ///< at the commanded A
  T at_B, at_C;        ///< actual, as declared
  bool squareness = false;
  Vector3<T> top, recorded; ///< only where effects act: t at the actual A; recorded commands less e
  bool effects() const { return at->freed.any(); } ///< some follow the nominal commands, which are the machine's sought
};
/// @param at outlives the pose  @param recorded commands
template <class T> Pose<T> pose_of(const At<T>& at, const Vector3<T>& recorded) {
  const T zero(0.0);
  Pose<T> pose{&at, {}, tip_at_top(at.q, at.c.A), at.c.B + at.q.E_BB, at.c.C + at.q.E_CC, has_squareness(at.q), {}, {}};
  // Squareness follows the nominal commands, which are the machine's that is sought.
  Quantities<T> q = at.q;
  q.S_XY = q.S_XZ = q.S_YZ = zero;
  const auto top = tip_at_top(q, T(at.c.A + q.E_AA)), added = linear_errors(q, zero, zero);
  pose.measured = top + added - recorded;
  pose.top = top, pose.recorded = recorded - added;
  return pose;
}

template <class T> class PoseRows {
public:
  explicit PoseRows(std::size_t readings) : poses(readings), rows_(3 * readings) {}

  std::vector<Pose<T>> poses;

  /// 11 derivatives and the residual of every row at theta, not whitened: [3 reading + axis][12].
  using Row = std::array<T, unknowns + 1>;
  const std::vector<Row>& linearise(const T* theta) {
    const auto lines = directions(Orientation<T>{theta[Q::E_A0B], theta[Q::E_C0B], theta[Q::E_A0C], theta[Q::E_B0C]});
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
      const Here here = at(pose, theta, length, lines);
      const Turns<T>& turns = here.moved.turns;
      const auto columns = probe_by_lengths(turns);
      const Vector3<T> from_c{length[length_probe_x] - length[length_C_x], -length[length_probe_y] - length[length_C_y],
                              -length[length_probe_z]};
      Vector3<T> from_b = Vector3<T>{length[length_C_x] - length[length_B_x], length[length_C_y], length[length_B_z]} +
                          turns.c * from_c;
      if (pose.effects()) from_b = from_b + here.moved.shift_C;
      const auto behind = [&](const Matrix3<T>& tilt, const Vector3<T>& v) { return pose.effects() ? tilt * v : v; };
      for (int j = 0; j < lengths; ++j) put(i, j, columns[static_cast<std::size_t>(j)]);
      put(i, Q::E_A0B, behind(here.moved.tilt_B, tilted(lines.b, b_A0B, here.at_B, from_b)));
      put(i, Q::E_C0B, behind(here.moved.tilt_B, tilted(lines.b, b_C0B, here.at_B, from_b)));
      put(i, Q::E_A0C, turns.b * behind(here.moved.tilt_C, tilted(lines.c, c_A0C, here.at_C, from_c)));
      put(i, Q::E_B0C, turns.b * behind(here.moved.tilt_C, tilted(lines.c, c_B0C, here.at_C, from_c)));
      put(i, unknowns, here.measured - here.probe);
      if (pose.squareness)
        for (int j = 0; j < unknowns; ++j) put(i, j, get(i, j) + squared(pose, get(i, j)));
    }
    return rows_;
  }

protected:
  /// One pose by the machine theta: where its probe stood, and should.
  struct Here {
    Vector3<T> measured, probe;
    T at_B, at_C;
    Moved<T> moved; ///< without effects only the turns
  };
  static Here at(const Pose<T>& pose, const T* theta, const T* length, const Directions<T>& lines) {
    Here h{pose.measured + square(pose, theta, lines), {}, pose.at_B, pose.at_C, {}};
    if (!pose.effects()) {
      h.moved.turns = exact_turns(lines, h.at_B, h.at_C);
      h.probe = sphere_calibration::probe_from_origin(length, h.moved.turns);
      return h;
    }
    const auto nominal =
        pose.tip - sphere_calibration::probe_from_origin(length, exact_turns(lines, pose.at->c.B, pose.at->c.C));
    const auto t = touch<T>(pose.at->c, nominal, pose.at->freed);
    h.at_B = h.at_B + t.rotary.B.error[chain::E_B], h.at_C = h.at_C + t.rotary.C.error[chain::E_C];
    h.moved = moved(exact_turns(lines, h.at_B, h.at_C), t.rotary);
    h.measured = pose.top - t.actual_of(pose.recorded - square(pose, theta, lines));
    h.probe = sphere_calibration::probe_from_origin(length, h.moved.turns) + h.moved.shift();
    return h;
  }
  /// Position of the probe without effects, from the effects at theta.
  static Vector3<T> undisturbed(const Pose<T>& pose, const T* theta, const Directions<T>& lines) {
    if (!pose.effects()) return pose.measured + square(pose, theta, lines);
    T length[lengths];
    actual(theta, pose, length);
    const Here h = at(pose, theta, length, lines);
    return h.measured -
           (h.probe - sphere_calibration::probe_from_origin(length, exact_turns(lines, pose.at_B, pose.at_C)));
  }

  /// By how much the probe of the machine theta moves where one axis turns from where it stands to `angle`.
  static Vector3<T> moved_to(const Pose<T>& pose, T Pose<T>::*axis, const T& angle, const T* theta,
                             const Directions<T>& lines) {
    T length[lengths];
    actual(theta, pose, length);
    Pose<T> there = pose;
    there.*axis = angle;
    const auto probe = [&](const Pose<T>& at) {
      return sphere_calibration::probe_from_origin(length, exact_turns(lines, at.at_B, at.at_C));
    };
    return probe(there) - probe(pose);
  }

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
    const T* link = &array_of(pose.at->q)[Q::link_B_x];
    for (int j = 0; j < 4; ++j) length[length_B_x + j] = length[length_B_x + j] + link[j];
  }
  /// Part of the recorded commands due to squareness, from the nominal commands.
  static Vector3<T> squared(const Pose<T>& pose, const Vector3<T>& nominal) {
    return {pose.at->q.S_XZ * nominal.z - pose.at->q.S_XY * nominal.y, T(0.0) - pose.at->q.S_YZ * nominal.z, T(0.0)};
  }
  static Vector3<T> square(const Pose<T>& pose, const T* theta, const Directions<T>& lines) {
    if (!pose.squareness) return {};
    T length[lengths];
    actual(theta, pose, length);
    return squared(
        pose, pose.tip - sphere_calibration::probe_from_origin(length, exact_turns(lines, pose.at->c.B, pose.at->c.C)));
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

} // namespace gumshoe::models::sphere_calibration
