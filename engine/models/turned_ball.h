#pragma once
/// A ball that rotary axes turn, as both models of the single socket method have it: rows of their cards, and the ball
/// made of such quantities.
#include "chain/turned_point.h"
#include "models/cards.h"
#include "models/reading.h"

namespace gumshoe::models::turned_ball {

using si::deg, si::mm;

// clang-format off: a row of a card stays together
#define GUMSHOE_BODY_ROWS                                                                                              \
  in_mm({.name = "pivot_x", .symbol = "x_1",                                                                           \
         .meaning = "nominal place of the pivot after the translation along X; for TTTRR of the axis of alpha"}),      \
  in_mm({.name = "pivot_y", .symbol = "y_1", .meaning = "the same along Y"}),                                          \
  in_mm({.name = "pivot_z", .symbol = "z_1", .meaning = "the same along Z"}),                                          \
  in_mm({.name = "point_x", .symbol = "x_r",                                                                           \
         .meaning = "nominal place of the ball from the pivot with all angles at 0 along X; for TTTRR from the centre "\
                    "of the turn by gamma"}),                                                                          \
  in_mm({.name = "point_y", .symbol = "y_r", .meaning = "the same along Y"}),                                          \
  in_mm({.name = "point_z", .default_value = -250 * mm, .symbol = "z_r",                                               \
         .meaning = "the same along Z; of a tool below the pivot it is negative"}),                                    \
  in_mm({.name = "z_alpha_gamma", .symbol = "z_alphagamma",                                                            \
         .meaning = "TTTRR: height of the centre of the turn by gamma above the axis of alpha; with [machine] it adds to the distance of the axes"}),                      \
  in_mm({.name = "seating_x", .meaning = "offset of the ball from its nominal place along X with all angles at 0; it " \
                                         "turns with the ball"}),                                                      \
  in_mm({.name = "seating_y", .meaning = "the same along Y"}),                                                         \
  in_mm({.name = "seating_z", .meaning = "the same along Z"}),                                                         \
  in_mm({.name = "nominal_x", .symbol = "x_2", .meaning = "nominal place of the ball after the rotation along X, as "  \
                                                          "stated; all three 0: as pivot, point and angles say"}),     \
  in_mm({.name = "nominal_y", .symbol = "y_2", .meaning = "the same along Y"}),                                        \
  in_mm({.name = "nominal_z", .symbol = "z_2", .meaning = "the same along Z"})
inline constexpr QuantityCard d_alpha_card = in_deg({.name = "d_alpha", .symbol = "Delta_alpha",
    .meaning = "true orientation error about X, actual minus commanded; only simulation reads it"}),
  d_beta_card = in_deg({.name = "d_beta", .symbol = "Delta_beta",
    .meaning = "true orientation error about Y of RRTTT and the head of RTTTR; only simulation reads it"}),
  d_gamma_card = in_deg({.name = "d_gamma", .symbol = "Delta_gamma",
    .meaning = "true orientation error about Z of TTTRR; only simulation reads it"});
inline constexpr VariableCard
  alpha_card = shown_in_deg({.name = "alpha", .meaning = "commanded angle about X"}),
  beta_card = shown_in_deg({.name = "beta", .meaning = "commanded angle about Y: RRTTT, head of RTTTR"}),
  gamma_card = shown_in_deg({.name = "gamma", .meaning = "commanded angle about Z: TTTRR"});
inline constexpr VariableCard closure_cards[] = {
    shown_in_mm({.name = "closure_x",
                 .meaning = "place of the ball along X as measured, minus where the angles found put it"}),
    shown_in_mm({.name = "closure_y", .meaning = "the same along Y"}),
    shown_in_mm({.name = "closure_z", .meaning = "the same along Z"}),
    shown_in_mm({.name = "closure_length",
                 .meaning = "distance of the ball from the pivot, measured minus nominal: no rotation changes it"})};
// clang-format on

/// The ball as it is nominally, and as it sits.
template <class T> struct Body {
  chain::TurnedPoint<T> nominal, seated;
  Vector3<T> turned; ///< nominal place after the rotation, from the nominal pivot, m
};
template <class T> struct Found {
  chain::Angles<T> error;
  Vector3<T> closure; ///< m
  T closure_length;   ///< m
};

template <class T, class Quantities> auto is_stated(const Quantities& q) {
  return num::abs(q.nominal_x) + num::abs(q.nominal_y) + num::abs(q.nominal_z) > T(0.0);
}
template <class T, class Quantities> Vector3<T> stated_from_pivot(const Quantities& q) {
  return Vector3<T>{q.nominal_x, q.nominal_y, q.nominal_z} - Vector3<T>{q.pivot_x, q.pivot_y, q.pivot_z};
}

/// The nominal place from the pivot: as stated, or else as computed.
template <class T, class Quantities> Vector3<T> nominal_place(const Quantities& q, const Vector3<T>& computed) {
  return choose(is_stated<T>(q), stated_from_pivot<T>(q), computed);
}
/// The axes of [machine]; where none is described, which refuse_machine refuses, any.
inline const chain::TwoRotaryAxes* axes_of(const void* context) {
  return context ? static_cast<const chain::TwoRotaryAxes*>(context) : &chain::table_BC;
}
/// @param context of the reading  @param q, c quantities of GUMSHOE_BODY_ROWS; alpha, beta, gamma
template <class T, class Quantities, class Conditions>
Body<T> body(chain::Turn turn, const void* context, const Quantities& q, const Conditions& c) {
  Body<T> b;
  b.nominal = {
      turn, {q.point_x, q.point_y, q.point_z}, q.z_alpha_gamma, {c.alpha, c.beta, c.gamma}, axes_of(context)};
  b.seated = b.nominal;
  b.seated.point = b.seated.point + Vector3<T>{q.seating_x, q.seating_y, q.seating_z};
  b.turned = nominal_place(q, place(b.nominal, b.nominal.commanded));
  return b;
}

/// Position error after the rotation. @param before position error that does not turn, m
template <class T> Vector3<T> after(const Body<T>& b, const Vector3<T>& before, const chain::Angles<T>& error) {
  return before + place(b.seated, b.seated.commanded + error) - b.turned;
}
/// The inverse. @param linear to first order in the errors
template <class T> Found<T> found(const Body<T>& b, const Vector3<T>& before, const Vector3<T>& after, bool linear) {
  const Vector3<T> v = b.turned + after - before;
  const auto error = linear ? linear_angle_errors(b.seated, v) : angle_errors(b.seated, v);
  const auto there = place(b.seated, b.seated.commanded + error);
  return {error, v - there, length(v) - length(there)};
}

/// Refuses the evaluation of a machine that is not described, and that of a printed one where a machine is.
template <class T, class Outcome> void refuse_machine(chain::Turn turn, const void* context, Outcome& outcome) {
  const T wrong((turn == chain::Turn::described) == (context != nullptr) ? 0.0 : 1.0);
  outcome.refuse(wrong > T(0.0), "the evaluation 'described' belongs to a [machine], and a [machine] to this evaluation");
}
/// Refuses commanded angles about axes that the machine does not have.
template <class T, class Outcome>
void refuse_angles(const std::array<bool, 3>& about, const chain::Angles<T>& angles, Outcome& outcome) {
  const auto other = chain::only<T>({!about[0], !about[1], !about[2]}, angles);
  outcome.refuse(num::abs(other.alpha) + num::abs(other.beta) + num::abs(other.gamma) > T(0.0),
                 "alpha, beta or gamma is not 0, but the machine has no such axis");
}
/// Refuses the distance of axes where the two do not stand apart.
template <class T, class Outcome> void refuse_distance(chain::Turn turn, const T& z_alpha_gamma, Outcome& outcome) {
  const T other = turn == chain::Turn::TTTRR || turn == chain::Turn::described ? T(0.0) : z_alpha_gamma;
  outcome.refuse(num::abs(other) > T(0.0), "z_alpha_gamma is not 0, but the machine is not TTTRR");
}
/// Refuses a ball that determines no angles, and a stated nominal place that contradicts the computed one.
/// @param turned mask: where the ball is turned
template <class T, class Quantities, class Mask>
void check(const Body<T>& b, const Quantities& q, const Mask& turned, Outcome<T>& outcome) {
  refuse_distance(b.nominal.turn, q.z_alpha_gamma, outcome);
  outcome.refuse(turned && (smallest_lever(b.seated) < T(1e-6)),
                 "point_x, point_y, point_z: the ball has no lever for one of the angles, so nothing determines it");
  const Vector3<T> computed = place(b.nominal, b.nominal.commanded);
  outcome.refuse(turned && is_stated<T>(q) && (length<T>(b.turned - computed) > T(1e-3)),
                 "nominal_x, nominal_y, nominal_z are over 1 mm from where pivot, point and angles put the ball");
}

} // namespace gumshoe::models::turned_ball
