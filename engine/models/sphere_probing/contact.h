#pragma once
/// A tip brought to a sphere on any serial machine, in any scalar: positions of both at given commands, and the
/// commands of three slides at which they meet.
///
/// The turns of the chain do not depend on the slides, so in the frame of the bed the gap between tip and sphere is
/// affine in their commands, whatever stands between them: gap(x) = gap(0) + J x. J's columns are the slides' actual
/// directions, turned by the axes before them; on the workpiece side they count against.
#include <vector>

#include "chain/machine.h"

namespace gumshoe::models::probing {

/// Motion of one axis, and the direction along which a slide goes.
template <class T> struct Moved {
  Pose<T> pose;
  Vector3<T> along;
};
/// @param e chain::error_kinds values
template <class T> Moved<T> moved(const chain::Axis& axis, bool slide, const T& command, const T* e) {
  Moved<T> m{chain::motion(axis, command, e), {}};
  if (slide) m.along = T(axis.sense) * chain::actual_line(axis, e).direction;
  return m;
}

/// Points: the tip from the spindle's reference point, the sphere's centre in the workpiece's frame, and where the tip
/// is to stand against that centre in the frame of the bed; m.
template <class T> struct Points { Vector3<T> tip, sphere, contact; };

template <class T> struct Contact {
  Vector3<T> tip, sphere; ///< in the frame of the bed
  Vector3<T> gap;         ///< tip - sphere - contact, likewise
  Matrix3<T> slides;      ///< J, by columns: the gap by the commands of the three slides
  Matrix3<T> workpiece;   ///< bed_from_workpiece's turn
};

/// @param moved      of every axis, in the machine's order
/// @param slide_of   0 to 2: column of J; -1: not one of the three
/// @param on_workpiece_side how many axes, the first ones
template <class T>
Contact<T> contact(const Moved<T>* moved, const std::vector<int>& slide_of, std::size_t on_workpiece_side,
                   const Points<T>& points) {
  Contact<T> c;
  const auto along = [&](std::size_t from, std::size_t to, const T& sign) {
    Pose<T> pose;
    for (std::size_t i = from; i < to; ++i) {
      if (const int s = slide_of[i]; s >= 0)
        (s == 0 ? c.slides.x : s == 1 ? c.slides.y : c.slides.z) = sign * (pose.turn * moved[i].along);
      pose = pose * moved[i].pose;
    }
    return pose;
  };
  const Pose<T> bed_from_workpiece = along(0, on_workpiece_side, T(-1.0));
  const Pose<T> bed_from_tool = along(on_workpiece_side, slide_of.size(), T(1.0));
  c.workpiece = bed_from_workpiece.turn;
  c.tip = bed_from_tool * points.tip;
  c.sphere = bed_from_workpiece * points.sphere;
  c.gap = c.tip - c.sphere - points.contact;
  return c;
}

/// Volume spanned by the slides' directions: 1 if square to each other, 0 if they reach a plane only.
template <class T> T span_of(const Matrix3<T>& J) { return dot(J.x, cross(J.y, J.z)); }
inline constexpr double least_span = 1e-6;

/// Increments of the slides' commands that close the gap, by Cramer's rule.
template <class T> Vector3<T> closing(const Contact<T>& c) {
  const Matrix3<T>& J = c.slides;
  const Vector3<T> yz = cross(J.y, J.z), wanted = T(1.0) / dot(J.x, yz) * -c.gap;
  return {dot(wanted, yz), dot(wanted, cross(J.z, J.x)), dot(wanted, cross(J.x, J.y))};
}

/// The gap as the workpiece sees it.
template <class T> Vector3<T> deviation(const Contact<T>& c) { return transposed(c.workpiece) * c.gap; }

} // namespace gumshoe::models::probing
