#pragma once
/// The trigger of a turning mill that is fed into the beam: the first moment at which any insert covers the trigger's
/// share. The tool's centre comes down from `start_height` by `drop` per radian of spindle angle, insert k stands at
/// start_angle + turned + k pitch and W_k higher than an unworn one:
///     first turned >= 0 with start_height + W_k - drop turned <= Zc(start_angle + turned + k pitch).
/// No time steps: revolutions above the highest Zc are passed at once, then humps of Zc + drop angle are isolated.
#include <span>

#include "chain/insert_height.h"

namespace gumshoe::chain {

inline constexpr int most_inserts = 12;

struct InsertMotion {
  double start_angle = 0;  ///< of the first insert, holder angle included, rad
  double start_height = 0; ///< of the tool's centre above the laser reference point, m
  double drop = 0;         ///< m per rad, positive
};

struct InsertTrigger {
  SolveStatus status = SolveStatus::ok;
  int insert = 0;    ///< from 0
  double turned = 0; ///< spindle angle from the start to the trigger, rad
  double height = 0; ///< of the tool's centre at the trigger
};

/// `already_covered`: an insert covers the share before anything moves. Absolute error of the height below 1e-12 m.
InsertTrigger insert_trigger(const InsertHeight& heights, std::span<const double> wear, const InsertMotion& motion);

/// The height with its derivatives: Newton steps in T at the trigger found, for one insert.
template <class T> struct InsertMotionOf {
  T angle;  ///< of the insert that triggers at the start, rad
  T height; ///< of the tool's centre at the start, m
  T wear;
  T drop;
};
template <class T>
T differentiable_trigger_height(const Insert<T>& insert, const Beam<T>& beam, const InsertMotionOf<T>& m,
                                const InsertTrigger& solved) {
  constexpr double pi = 3.14159265358979323846;
  const InsertBody<T> body = insert_body(insert, beam);
  const T target = beam.fraction * (pi * (beam.radius * beam.radius));
  T turned(solved.turned);
  for (int level = 0; level < num::derivative_levels<T>; ++level) {
    const T angle = m.angle + turned, k = body.cos_pitch * (m.height + m.wear - m.drop * turned);
    const InsertShadow<T> shadow = insert_shadow(body, angle);
    const InsertShadow<double> plain = converted<double>(shadow);
    const InsertParts parts = insert_parts(plain, joints(plain), num::value(k), num::value(beam.radius));
    const auto moving = Dual<double, 1>::variable(num::value(turned), 0);
    const auto turning = insert_shadow(converted<Dual<double, 1>>(body), num::value(m.angle) + moving);
    const double fall = num::value(body.cos_pitch * m.drop);
    const double slope = insert_cover(turning, joints(turning), num::value(k) - fall * (moving - num::value(turned)),
                                      Dual<double, 1>(num::value(beam.radius)), parts)
                             .area.d[0];
    const auto cover = insert_cover(shadow, joints(shadow), k, beam.radius, parts);
    turned = turned - (cover.area - target) / slope;
  }
  return m.height - m.drop * turned;
}

} // namespace gumshoe::chain
