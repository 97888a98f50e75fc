#pragma once
/// Orientation errors of a five-axis machine from its position errors before and after a rotation: the second step of
/// the single socket method. A reading is one movement.
#include "models/model.h"
#include "models/turned_ball.h"

namespace gumshoe::models::single_socket_rotation {

using namespace turned_ball;

inline constexpr QuantityCard quantity_cards[] = {
    GUMSHOE_BODY_ROWS,
    in_mm({.name = "before_x",
           .symbol = "Delta_xV1",
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
    closure_cards[0],
    closure_cards[1],
    closure_cards[2],
    closure_cards[3]};

#define GUMSHOE_FOUND                                                                                                  \
  { "v = nominal + after - pivot - before", "v: the ball from the pivot, as measured" }
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
    {.name = "rtttr_head",
     .meaning = "the axis in the head of a machine with one in each, exact",
     .equations = head_equations},
    {.name = "rtttr_table", .meaning = "the axis in its table, exact", .equations = table_equations},
    {.name = "rrttt_linear", .meaning = "eqs (6) and (7)", .equations = linear_rrttt_equations},
    {.name = "tttrr_linear", .meaning = "eqs (11) and (12), corrected", .equations = linear_tttrr_equations},
    {.name = "rtttr_head_linear", .meaning = "eq (17)", .equations = linear_head_equations},
    {.name = "rtttr_table_linear", .meaning = "eq (18)", .equations = linear_table_equations},
    {.name = "described",
     .meaning = "both rotary axes of [machine], in table or head, by least squares",
     .equations = described_equations},
};
inline constexpr int described = 8;
constexpr chain::Turn turn_of(int evaluation) {
  return evaluation == described ? chain::Turn::described : static_cast<chain::Turn>(evaluation % 4);
}
constexpr bool is_linear(int evaluation) { return evaluation >= 4 && evaluation != described; }

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
  /// Directions about which the machine of a reading turns the ball: X, Y, Z.
  template <class T> static std::array<bool, 3> turns(const At<T>& at) {
    return chain::turns_about(turn_of(at.evaluation), axes_of(at.context));
  }
  template <class T> static Body<T> body(const At<T>& at) {
    return turned_ball::body<T>(turn_of(at.evaluation), at.context, at.q, at.c);
  }
  template <class T> static Vector3<T> before(const At<T>& at) { return {at.q.before_x, at.q.before_y, at.q.before_z}; }

  template <class T> static void check_commanded(const At<T>& at, Outcome<T>& outcome) {
    turned_ball::refuse_machine<T>(turn_of(at.evaluation), at.context, outcome);
    turned_ball::refuse_angles<T>(turns(at), {at.c.alpha, at.c.beta, at.c.gamma}, outcome);
  }
  template <class T> static void check(const At<T>& at, Outcome<T>& outcome) {
    turned_ball::check(body(at), at.q, T(0.0) == T(0.0), outcome);
  }
  template <class T> static Simulated<Rows, T> simulate(const At<T>& at, Outcome<T>&) {
    const auto error = chain::only<T>(turns(at), {at.q.d_alpha, at.q.d_beta, at.q.d_gamma});
    const auto x = after(body(at), before(at), error);
    const T none(0.0);
    return {{x.x, x.y, x.z}, {error.alpha, error.beta, error.gamma, none, none, none, none}};
  }
  template <class T>
  static Rows::Measurands<T> evaluate(const At<T>& at, const Rows::Indications<T>& read, Outcome<T>& outcome) {
    const auto f = found(body(at), before(at), {read.after_x, read.after_y, read.after_z}, is_linear(at.evaluation));
    const T sum = f.error.alpha + f.error.beta + f.error.gamma;
    outcome.refuse(!(num::abs(sum) < T(huge)));
    return {f.error.alpha, f.error.beta, f.error.gamma, f.closure.x, f.closure.y, f.closure.z, f.closure_length};
  }
  static MadeModel on_machine(const chain::MachineDescription& machine, std::string& why);
};

} // namespace gumshoe::models::single_socket_rotation
