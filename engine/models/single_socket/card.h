#pragma once
/// Card of the single socket model: quantities, conditions, measurands, evaluations.
#include "models/turned_ball.h"

namespace gumshoe::models::single_socket {

using namespace turned_ball;
using chain::Turn, si::um;

// clang-format off: a row of a card stays together
inline constexpr QuantityCard quantity_cards[] = {
    in_mm({.name = "reference_x", .symbol = "x_0", .meaning = "place of the fixed ball, in the socket, along X"}),
    in_mm({.name = "reference_y", .symbol = "y_0", .meaning = "the same along Y"}),
    in_mm({.name = "reference_z", .symbol = "z_0", .meaning = "the same along Z"}),
    in_mm({.name = "bar_length", .limits = not_negative, .symbol = "l_n",
           .meaning = "nominal distance of the balls, from which length_change counts; 0: as their places say"}),
    {.name = "bar_zero", .unit = "um", .si_unit = "m", .limits = any,
     .meaning = "indication of the bar where length_change is truly 0"},
    {.name = "bar_expansion", .unit = "um/m/K", .si_unit = "1/K", .default_value = 11.5e-6, .limits = {-1e-4, 1e-4},
     .meaning = "coefficient of linear thermal expansion of the bar"},
    {.name = "temperature_difference", .unit = "K", .si_unit = "K", .limits = {-200, 200},
     .meaning = "temperature of the bar at the reading minus that at which it was set"},
    GUMSHOE_BODY_ROWS,
    in_mm({.name = "position_error_x", .symbol = "Delta_x",
           .meaning = "true position error after the translation along X, of the machine without the ball's seating; "
                      "only simulation reads it"}),
    in_mm({.name = "position_error_y", .symbol = "Delta_y", .meaning = "the same along Y"}),
    in_mm({.name = "position_error_z", .symbol = "Delta_z", .meaning = "the same along Z"}),
    d_alpha_card,
    d_beta_card,
    d_gamma_card,
};
inline constexpr VariableCard condition_cards[] = {
    shown_in_mm({.name = "station_x", .default_value = 150 * mm,
                 .meaning = "commanded place of the moving ball along X, x_P; its error is the position error"}),
    shown_in_mm({.name = "station_y", .meaning = "the same along Y"}),
    shown_in_mm({.name = "station_z", .meaning = "the same along Z"}),
    shown_pure({.name = "step", .default_value = 1,
                .meaning = "1: after the translation; 2: after the rotation as well"}),
    alpha_card,
    beta_card,
    gamma_card,
    shown_pure({.name = "direction", .default_value = -1, .meaning = "from which every slide came: 1, -1, or 0"}),
    shown_in_s({.name = "time", .meaning = "since the start of the work"}),
    {.name = "speed", .unit = "mm/s", .si_unit = "m/s", .default_value = 0,
     .meaning = "rate at which the bar's length changes while it is read; 0 at rest"},
};
inline constexpr VariableCard indication_cards[] = {
    {.name = "length_change", .unit = "um", .si_unit = "m", .default_value = 0,
     .meaning = "change of the bar's length from bar_length, Delta_l"}};
inline constexpr VariableCard measurand_cards[] = {
    {.name = "length_error", .unit = "um", .si_unit = "m", .default_value = 0,
     .meaning = "distance of the balls, actual minus nominal: length_change without the bar's own errors"}};

inline constexpr VariableCard
    residual_card{"residual_rms", "um", "m", 0,
                  "root mean square of what the position errors leave of the length changes; 0 with three stations"},
    amplification_card = shown_diagnostic({.name = "amplification",
        .meaning = "standard uncertainty of a position error by that of a length change, root mean square over X, Y, "
                   "Z, of the worse step: 1 for three directions square to each other"});
inline constexpr VariableCard position_cards[] = {
    shown_in_mm({.name = "position_error_x", .meaning = "position error along X, without the ball's seating"}),
    shown_in_mm({.name = "position_error_y", .meaning = "the same along Y"}),
    shown_in_mm({.name = "position_error_z", .meaning = "the same along Z"}),
    residual_card, amplification_card};
#define GUMSHOE_STEPS                                                                                                  \
  shown_in_mm({.name = "before_x", .meaning = "position error after the translation along X, without the ball's "      \
                                              "seating"}),                                                             \
  shown_in_mm({.name = "before_y", .meaning = "the same along Y"}),                                                    \
  shown_in_mm({.name = "before_z", .meaning = "the same along Z"}),                                                    \
  shown_in_mm({.name = "after_x", .meaning = "position error of the ball after the rotation along X"}),                \
  shown_in_mm({.name = "after_y", .meaning = "the same along Y"}),                                                     \
  shown_in_mm({.name = "after_z", .meaning = "the same along Z"}),                                                     \
  closure_cards[0], closure_cards[1], closure_cards[2], closure_cards[3]
inline constexpr VariableCard d_alpha = shown_in_deg({.name = "d_alpha", .meaning = "orientation error about X"}),
                              d_beta = shown_in_deg({.name = "d_beta", .meaning = "orientation error about Y"}),
                              d_gamma = shown_in_deg({.name = "d_gamma", .meaning = "orientation error about Z"});
template <Turn> inline constexpr auto cards = nullptr;
#define GUMSHOE_END residual_card, amplification_card
template <> inline constexpr VariableCard cards<Turn::RRTTT>[] = {GUMSHOE_STEPS, d_alpha, d_beta, GUMSHOE_END};
template <> inline constexpr VariableCard cards<Turn::TTTRR>[] = {GUMSHOE_STEPS, d_alpha, d_gamma, GUMSHOE_END};
template <> inline constexpr VariableCard cards<Turn::RTTTR_head>[] = {GUMSHOE_STEPS, d_beta, GUMSHOE_END};
template <> inline constexpr VariableCard cards<Turn::RTTTR_table>[] = {GUMSHOE_STEPS, d_alpha, GUMSHOE_END};
/// [machine] gives these the names d_alpha, d_beta, d_gamma.
inline constexpr std::string_view first_error = "d_first", second_error = "d_second";
template <> inline constexpr VariableCard cards<Turn::described>[] = {
    GUMSHOE_STEPS,
    shown_in_deg({.name = first_error, .meaning = "orientation error of the first rotary axis from the bed; [machine] names it by its direction"}),
    shown_in_deg({.name = second_error, .meaning = "that of the second one"}), GUMSHOE_END};
#undef GUMSHOE_END
#undef GUMSHOE_STEPS

#define GUMSHOE_SYMBOLS                                                                                                \
  "i: station; D: position error; P_0: reference; l: bar_length; least squares from four stations on"
#define GUMSHOE_TURNED "nominal + after = pivot + before + R(angles + errors) * (point + seating)"
inline constexpr EquationCard length_equations[] = {
    {"length_error = length_change - bar_zero + l * bar_expansion * temperature_difference", "l: bar_length"}};
inline constexpr EquationCard exact_equations[] = {
    {"abs(P_i + D - P_0) = l_i + length_error_i", GUMSHOE_SYMBOLS}, length_equations[0]};
inline constexpr EquationCard linear_equations[] = {
    {"(P_i - P_0) * D = d_i * (l_i + length_error_i - d_i)", GUMSHOE_SYMBOLS "; d: distance of P_i and P_0"},
    length_equations[0]};
inline constexpr EquationCard turned_equations[] = {
    {GUMSHOE_TURNED, "R: turns of the machine; solved as in single_socket_rotation"},
    exact_equations[0], length_equations[0]};
inline constexpr EquationCard turned_linear_equations[] = {
    {GUMSHOE_TURNED, "R: turns of the machine, to first order in the errors as in single_socket_rotation"},
    linear_equations[0], length_equations[0]};
inline constexpr EquationCard turned_described_equations[] = {
    {GUMSHOE_TURNED, "R: turns about the axes of the machine; least squares in X, Y and Z"},
    exact_equations[0], length_equations[0]};
#undef GUMSHOE_TURNED
#undef GUMSHOE_SYMBOLS

// The first is computed at each reading; then the joint evaluations, those of a rotation in the order of chain::Turn.
enum Evaluation { each_length, position, position_linear, rotated, rotated_linear = rotated + 4, described = rotated_linear + 4 };
constexpr bool is_rotated(int evaluation) { return evaluation >= rotated; }
constexpr bool is_linear(int evaluation) {
  return evaluation == position_linear || (evaluation >= rotated_linear && evaluation != described);
}
constexpr Turn turn_of(int evaluation) {
  return evaluation == described ? Turn::described : static_cast<Turn>((evaluation - rotated) % 4);
}
#define GUMSHOE_TURN(name_, meaning_, turn, equations_)                                                                \
  {.name = name_, .meaning = meaning_, .measurands = cards<turn>, .equations = equations_}
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "length", .meaning = "of one reading", .equations = length_equations},
    {.name = "position", .meaning = "position errors from three or more stations, exact", .measurands = position_cards,
     .equations = exact_equations},
    {.name = "position_linear", .meaning = "eq (1), of first order", .measurands = position_cards,
     .equations = linear_equations},
    GUMSHOE_TURN("rrttt", "both steps with two axes in the head, exact", Turn::RRTTT, turned_equations),
    GUMSHOE_TURN("tttrr", "both steps with two axes in the table, exact", Turn::TTTRR, turned_equations),
    GUMSHOE_TURN("rtttr_head", "both steps with the axis in the head of a machine with one in each, exact",
                 Turn::RTTTR_head, turned_equations),
    GUMSHOE_TURN("rtttr_table", "both steps with the axis in its table, exact", Turn::RTTTR_table, turned_equations),
    GUMSHOE_TURN("rrttt_linear", "eqs (1), (6) and (7)", Turn::RRTTT, turned_linear_equations),
    GUMSHOE_TURN("tttrr_linear", "eqs (1), (11) and (12), corrected", Turn::TTTRR, turned_linear_equations),
    GUMSHOE_TURN("rtttr_head_linear", "eqs (1) and (17)", Turn::RTTTR_head, turned_linear_equations),
    GUMSHOE_TURN("rtttr_table_linear", "eqs (1) and (18)", Turn::RTTTR_table, turned_linear_equations),
    GUMSHOE_TURN("described", "both steps with both rotary axes of [machine], in table or head, exact", Turn::described,
                 turned_described_equations),
};
#undef GUMSHOE_TURN
inline constexpr Stage stages[] = {Stage::motion, Stage::slides, Stage::slide_directions, Stage::bar};
// clang-format on

} // namespace gumshoe::models::single_socket
