#pragma once
/// A probe behind two rotary axes, B and C on B, that touches along Z: what the stages rotary, slides and contact see
/// and add to. Errors are actual minus commanded, by ISO 230-1 and ISO 230-7, those of a slide counted along its
/// commands.
#include "chain/axis.h"
#include "chain/probing_event.h"

namespace gumshoe::chain {

/// A slide's actual position = commanded (1 + scale) + error, m.
template <class T> struct SlideError { T error = T(0.0), scale = T(0.0); };

template <class T> struct RotaryProbing {
  // commanded, known to effects
  T B = T(0.0), C = T(0.0);                     ///< rad
  T B_direction = T(1.0), C_direction = T(1.0); ///< from which the position was reached, +1 or -1
  T B_clamped = T(0.0), C_clamped = T(0.0);     ///< 1: the axis' brake holds
  Vector3<T> position;                          ///< of the slides, by the quantities, m
  Vector3<T> approach;                          ///< of the tip against the sphere, unit vector in the probe's frame
  // rotary: E_X ... E_C of each axis; the positioning errors are B_error[E_B], C_error[E_C]
  T B_error[E_X0], C_error[E_X0];
  // slides: X and Y; Z's are ProbingEvent's
  SlideError<T> X, Y;
  // contact
  T pretravel = T(0.0); ///< on along the approach from contact to trigger, m

  RotaryProbing() {
    for (int k = 0; k < E_X0; ++k) B_error[k] = C_error[k] = T(0.0);
  }
};

/// Direction of an approach along machine Z, in the frame of a probe that B and then C have turned: Rz(-C) Ry(-B) z.
/// @param direction +1 or -1 along Z  @param B, C rad
template <class T> Vector3<T> approach_in_probe(const T& direction, const T& B, const T& C) {
  const T across = direction * num::sin(B);
  return {-(across * num::cos(C)), across * num::sin(C), direction * num::cos(B)};
}

/// What the error motions of both axes do to the turns about their lines and to the points on them: the axes' lines
/// move by `shift`, all behind them turns by `tilt`, chain::motion.
template <class T> struct ErrorMotion {
  Matrix3<T> tilt;
  Vector3<T> shift;
};
/// @param error      E_X ... E_C of the axis  @param direction 1: B, 2: C; positioning is not read, it is part of the
/// turn
template <class T> ErrorMotion<T> error_motion(const T* error, int direction) {
  const T zero(0.0);
  return {rotation(error[E_A], direction == 1 ? zero : error[E_B], direction == 2 ? zero : error[E_C]),
          {error[E_X], error[E_Y], error[E_Z]}};
}

/// What the control reads when the tip touches with the slides truly at `actual`, and the inverse.
template <class T>
Vector3<T> reading_of(const Vector3<T>& actual, const ProbingEvent<T>& event, const RotaryProbing<T>& probing) {
  return {(actual.x - probing.X.error) / (1.0 + probing.X.scale),
          (actual.y - probing.Y.error) / (1.0 + probing.Y.scale),
          reading_of(T(actual.z + event.direction * probing.pretravel), event)};
}
template <class T>
Vector3<T> actual_of(const Vector3<T>& reading, const ProbingEvent<T>& event, const RotaryProbing<T>& probing) {
  return {reading.x * (1.0 + probing.X.scale) + probing.X.error, reading.y * (1.0 + probing.Y.scale) + probing.Y.error,
          actual_of(reading.z, event) - event.direction * probing.pretravel};
}

} // namespace gumshoe::chain
