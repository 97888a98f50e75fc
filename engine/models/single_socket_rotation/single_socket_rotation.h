#pragma once
/// Orientation errors of a five-axis machine from its position errors before and after a rotation: the second step of
/// the single socket method. A reading is one movement.
#include "models/model.h"
#include "models/single_socket_rotation/described.h"
#include "models/turned_ball.h"

namespace gumshoe::models::single_socket_rotation {

using namespace turned_ball;

inline constexpr QuantityCard quantity_cards[] = {
    GUMSHOE_BODY_ROWS,
    in_mm({.name = "before_x", .symbol = "Delta_xV1",
           .meaning = "position error after the translation along X that does not turn with the ball; the part that "
                      "does is seating_x"}),
    in_mm({.name = "before_y", .symbol = "Delta_yV1", .meaning = "the same along Y"}),
    in_mm({.name = "before_z", .symbol = "Delta_zV1", .meaning = "the same along Z"}),
    d_alpha_card,
    d_beta_card,
    d_gamma_card,
};
inline constexpr VariableCard condition_cards[] = {alpha_card, beta_card, gamma_card};
inline constexpr VariableCard indication_cards[] = {
    shown_in_mm({.name = "after_x", .meaning = "position error after the rotation along X, as the ball bar gives it"}),
    shown_in_mm({.name = "after_y", .meaning = "the same along Y"}),
    shown_in_mm({.name = "after_z", .meaning = "the same along Z"})};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_deg({.name = "d_alpha", .meaning = "orientation error about X; 0 for the head of RTTTR"}),
    shown_in_deg({.name = "d_beta", .meaning = "orientation error about Y; 0 for TTTRR and the table of RTTTR"}),
    shown_in_deg({.name = "d_gamma", .meaning = "orientation error about Z; 0 for all but TTTRR"}),
    closure_cards[0], closure_cards[1], closure_cards[2], closure_cards[3]};

#define GUMSHOE_FOUND                                                                                                  \
  {"v = nominal + after - pivot - before", "v: the ball from the pivot, as measured"}
inline constexpr EquationCard rrttt_equations[] = {
    GUMSHOE_FOUND, {"v = R_x(alpha + d_alpha) * R_y(beta + d_beta) * (point + seating) * k", "k: lengthens to abs(v)"}};
inline constexpr EquationCard tttrr_equations[] = {
    GUMSHOE_FOUND,
    {"v = R_x(alpha + d_alpha) * (R_z(gamma + d_gamma) * (point + seating) + z_alpha_gamma)",
     "solved in X, then in Y"}};
inline constexpr EquationCard head_equations[] = {
    GUMSHOE_FOUND, {"v = R_y(beta + d_beta) * (point + seating) * k", "in X and Z; k: lengthens to abs(v)"}};
inline constexpr EquationCard table_equations[] = {
    GUMSHOE_FOUND, {"v = R_x(alpha + d_alpha) * (point + seating) * k", "in Y and Z; k: lengthens to abs(v)"}};
inline constexpr EquationCard linear_rrttt_equations[] = {
    GUMSHOE_FOUND,
    {"d_beta = (v_x - z_r * sin(beta)) / (z_r * cos(beta))",
     "z_r: point_z + seating_z; for a ball on the spindle's axis"},
    {"d_alpha = (v_y * cos(alpha) + v_z * sin(alpha)) / (v_y * sin(alpha) - v_z * cos(alpha))", "likewise"}};
inline constexpr EquationCard linear_tttrr_equations[] = {
    GUMSHOE_FOUND,
    {"d_gamma = (x_r * cos(gamma) - y_r * sin(gamma) - v_x) / s",
     "x_r, y_r, z_r: point + seating; s: x_r sin(gamma) + y_r cos(gamma)"},
    {"d_alpha = (cos(alpha) * K - (v_y + w * sin(alpha)) * s) / (w * cos(alpha) * s + sin(alpha) * K)",
     "w: z_r + z_alpha_gamma; K: x_r^2 + y_r^2 - v_x (x_r cos(gamma) - y_r sin(gamma))"}};
inline constexpr EquationCard linear_head_equations[] = {GUMSHOE_FOUND, linear_rrttt_equations[1]};
inline constexpr EquationCard linear_table_equations[] = {
    GUMSHOE_FOUND,
    {"d_alpha = (y_r * cos(alpha) - z_r * sin(alpha) - v_y) / (z_r * cos(alpha) + y_r * sin(alpha))",
     "y_r, z_r: point + seating"}};
inline constexpr EquationCard described_equations[] = {
    GUMSHOE_FOUND,
    {"norm(v - R_1 * (offset + R_2 * (point + seating))) = minimum",
     "R_1, R_2: turns about the axes of the machine by commanded angles and errors; offset: between their points"}};
#undef GUMSHOE_FOUND

/// In the order of chain::Turn, exact and then linear.
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "rrttt", .meaning = "two axes in the head, exact", .equations = rrttt_equations},
    {.name = "tttrr", .meaning = "two axes in the table, exact", .equations = tttrr_equations},
    {.name = "rtttr_head", .meaning = "the axis in the head of a machine with one in each, exact",
     .equations = head_equations},
    {.name = "rtttr_table", .meaning = "the axis in its table, exact", .equations = table_equations},
    {.name = "rrttt_linear", .meaning = "eqs (6) and (7)", .equations = linear_rrttt_equations},
    {.name = "tttrr_linear", .meaning = "eqs (11) and (12), corrected", .equations = linear_tttrr_equations},
    {.name = "rtttr_head_linear", .meaning = "eq (17)", .equations = linear_head_equations},
    {.name = "rtttr_table_linear", .meaning = "eq (18)", .equations = linear_table_equations},
    {.name = "described", .meaning = "both rotary axes of [machine], in table or head, by least squares",
     .equations = described_equations},
};
inline constexpr int described = 8;
constexpr chain::Turn turn_of(int evaluation) { return static_cast<chain::Turn>(evaluation % 4); }
constexpr bool is_linear(int evaluation) { return evaluation >= 4; }
/// Directions about which the machine of an evaluation turns the ball: X, Y, Z. @param axes of `described`
inline std::array<bool, 3> turns(int evaluation, const chain::TwoRotaryAxes* axes) {
  if (evaluation != described) return chain::turns_about(turn_of(evaluation));
  std::array<bool, 3> about{};
  for (const int direction : {axes->first.direction, axes->second.direction})
    about[static_cast<std::size_t>(direction)] = true;
  return about;
}

struct SingleSocketRotation {
  struct Rows {
    GUMSHOE_NAMED(Quantities, pivot_x, pivot_y, pivot_z, point_x, point_y, point_z, z_alpha_gamma, seating_x, seating_y,
                  seating_z, nominal_x, nominal_y, nominal_z, before_x, before_y, before_z, d_alpha, d_beta, d_gamma);
    GUMSHOE_NAMED(Conditions, alpha, beta, gamma);
    GUMSHOE_NAMED(Indications, after_x, after_y, after_z);
    GUMSHOE_NAMED(Measurands, d_alpha, d_beta, d_gamma, closure_x, closure_y, closure_z, closure_length);
  };
  template <class T> using At = Reading<Rows, T>;
  static constexpr ModelCard card{
      .name = "single_socket_rotation",
      .title = "Orientation errors of a five-axis machine from position errors before and after a rotation",
      .summary = "The position errors of a ball are known before and after two rotary axes turn it; the orientation "
                 "errors of these axes follow, and what no rotation explains.",
      .source = "Wang, Yu, Liao 2013, eqs (2) to (18), corrected; see reports/errata.md",
      .quantities = quantity_cards,
      .conditions = condition_cards,
      .indications = indication_cards,
      .measurands = measurand_cards,
      .evaluations = evaluation_cards,
      .stages = {}};

  /// Every evaluation has its machine; that of a linear one is the exact one's.
  static int machine_of(int evaluation) { return evaluation == described ? described : evaluation % 4; }
  /// Those of [machine]; where none is described, which is refused, any.
  static const chain::TwoRotaryAxes* axes(const void* context) {
    return context ? static_cast<const chain::TwoRotaryAxes*>(context) : &chain::table_BC;
  }
  template <class T> static Described<T> on_axes(const At<T>& at) {
    const auto& two = *axes(at.context);
    const Vector3<T> up{T(0.0), T(0.0), at.q.z_alpha_gamma};
    return {two, chain::point_of<T>(two.second) - chain::point_of<T>(two.first) + up};
  }
  template <class T> static Body<T> body(const At<T>& at) {
    auto b = turned_ball::body<T>(turn_of(at.evaluation), at.q, at.c);
    if (at.evaluation == described)
      b.turned = nominal_place(at.q, on_axes(at).place(b.nominal.point, b.nominal.commanded));
    return b;
  }
  template <class T> static Vector3<T> before(const At<T>& at) { return {at.q.before_x, at.q.before_y, at.q.before_z}; }

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    const T wrong((at.evaluation == described) == (at.context != nullptr) ? 0.0 : 1.0);
    outcome.refuse(wrong > T(0.0),
                   "the evaluation 'described' belongs to a [machine], and a [machine] to this evaluation");
    turned_ball::refuse_angles<T>(turns(at.evaluation, axes(at.context)), {at.c.alpha, at.c.beta, at.c.gamma}, outcome);
  }
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    const auto everywhere = T(0.0) == T(0.0);
    const auto b = body(at);
    if (at.evaluation != described) {
      turned_ball::refuse_distance(turn_of(at.evaluation), at.q.z_alpha_gamma, outcome);
      return turned_ball::check(b, at.q, everywhere, outcome);
    }
    const auto ball = on_axes(at);
    turned_ball::refuse_levers(ball.smallest_lever(b.seated.point, b.seated.commanded), everywhere, outcome);
    turned_ball::refuse_nominal(b, ball.place(b.nominal.point, b.nominal.commanded), at.q, everywhere, outcome);
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>&) {
    const auto error =
        chain::only<T>(turns(at.evaluation, axes(at.context)), {at.q.d_alpha, at.q.d_beta, at.q.d_gamma});
    const auto b = body(at);
    const auto x = at.evaluation == described
                       ? before(at) + on_axes(at).place(b.seated.point, b.seated.commanded + error) - b.turned
                       : after(b, before(at), error);
    const T none(0.0);
    return {{x.x, x.y, x.z}, {error.alpha, error.beta, error.gamma, none, none, none, none}};
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>& outcome) {
    const Vector3<T> shown{read.after_x, read.after_y, read.after_z};
    const auto f = at.evaluation == described ? found_on_axes(at, shown)
                                              : found(body(at), before(at), shown, is_linear(at.evaluation));
    const T sum = f.error.alpha + f.error.beta + f.error.gamma;
    outcome.refuse(!(num::abs(sum) < T(huge)));
    return {f.error.alpha, f.error.beta, f.error.gamma, f.closure.x, f.closure.y, f.closure.z, f.closure_length};
  }
  template <class T> static Found<T> found_on_axes(const At<T>& at, const Vector3<T>& shown) {
    const auto b = body(at);
    const auto ball = on_axes(at);
    const Vector3<T> v = b.turned + shown - before(at);
    const auto error = ball.errors(b.seated.point, b.seated.commanded, v);
    const auto there = ball.place(b.seated.point, b.seated.commanded + error);
    return {error, v - there, turned_ball::length(v) - turned_ball::length(there)};
  }
  static MadeModel on_machine(const chain::MachineDescription& machine, std::string& why);
};

} // namespace gumshoe::models::single_socket_rotation
