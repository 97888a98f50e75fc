#pragma once
/// A probe behind two rotary axes, B and C on B: what the stage rotary sees and adds to, and what the errors of these
/// axes do. Errors are actual minus commanded, by ISO 230-1 and ISO 230-7.
#include "chain/axis.h"
#include "chain/probing_event.h"

namespace gumshoe::chain {

/// A rotary axis at the event.
template <class T> struct RotaryMotion {
  // commanded, known to effects
  T angle = T(0.0);     ///< rad
  T direction = T(1.0); ///< from which the angle was reached, +1 or -1; 0 neither
  T clamped = T(0.0);   ///< 1 where the axis' brake holds
  T sense = T(1.0);     ///< of the turn at a positive command: -1 if the axis carries the workpiece
  // effects add to
  T error[E_X0]; ///< E_X ... E_C, m and rad; the positioning error is the one about the axis itself

  RotaryMotion() {
    for (T& e : error) e = T(0.0);
  }
};

template <class T> struct RotaryProbing { RotaryMotion<T> B, C; };

/// Direction of an approach along machine Z, in the frame of a probe that B and then C have turned: Rz(-C) Ry(-B) z.
/// @param direction +1 or -1 along Z  @param B, C rad
template <class T> Vector3<T> approach_in_probe(const T& direction, const T& B, const T& C) {
  const T across = direction * num::sin(B);
  return {-(across * num::cos(C)), across * num::sin(C), direction * num::cos(B)};
}

/// What the error motions of an axis do to the turns about its line and to the points on it: the line moves by
/// `shift`, all behind it turns by `tilt`, chain::motion.
template <class T> struct ErrorMotion {
  Matrix3<T> tilt;
  Vector3<T> shift;
};
/// @param error      E_X ... E_C of the axis, m and rad; its positioning error is not read, it is part of the turn
/// @param direction  1 for B, 2 for C
template <class T> ErrorMotion<T> error_motion(const T* error, int direction) {
  const T zero(0.0);
  return {rotation(error[E_A], direction == 1 ? zero : error[E_B], direction == 2 ? zero : error[E_C]),
          {error[E_X], error[E_Y], error[E_Z]}};
}

} // namespace gumshoe::chain
