#pragma once
/// Card of the linear axis: quantities, conditions, indication, measurands, evaluations.
#include "chain/linear_axis.h"
#include "models/cards.h"

namespace gumshoe::models::linear_axis {

// clang-format off: a row of a card stays together
constexpr QuantityCard in_um(std::string_view name, std::string_view meaning) {
  return in_units({.name = name, .meaning = meaning}, "um", "m");
}
constexpr QuantityCard per_length(std::string_view name, std::string_view meaning) {
  return in_units({.name = name, .limits = {-1e-2, 1e-2}, .meaning = meaning}, "um/m", "1");
}
inline constexpr QuantityCard quantity_cards[] = {
    in_um("offset", "true deviation at the datum; only simulation reads it"),
    per_length("gain", "true growth of the deviation with the travel from the datum; only simulation reads it"),
    per_length("reference_scale", "the reference indicates a travel too long by this share: wavelength, air, calibration"),
    in_units({.name = "reference_drift", .limits = {-1e-6, 1e-6},
              .meaning = "by which the indication of the reference rises with time while the axis stands still"}, "um/h", "m/s"),
    in_units({.name = "misalignment", .limits = {-0.1, 0.1},
              .meaning = "angle between the axis and the line along which the reference measures (cosine error)"}, "mrad", "rad"),
    in_mm({.name = "dead_path", .limits = not_negative,
           .meaning = "length of the beam at the datum that the reference does not compensate; the travel leads away from the interferometer"}),
    per_length("wavelength_change", "growth of the wavelength since the reference was set to zero: it makes the indication too small by "
                                    "dead_path wavelength_change"),
    in_units({.name = "expansion", .default_value = 11.5e-6, .limits = {-1e-4, 1e-4},
              .meaning = "coefficient of linear thermal expansion of the axis' scale, by which results are reduced to 20 degC"}, "um/m/K", "1/K"),
    in_units({.name = "temperature_difference", .limits = {-200, 200},
              .meaning = "temperature of the axis' scale minus 20 degC, by which results are reduced to 20 degC"}, "K", "K"),
};
inline constexpr VariableCard condition_cards[] = {
    shown_in_mm({.name = "position", .meaning = "target"}),
    shown_pure({.name = "direction", .default_value = 1, .meaning = "from which the target was reached: 1 upwards, -1 downwards"}),
    shown_in_s({.name = "time", .meaning = "since the start of the work"}),
    shown_in_mm({.name = "datum", .meaning = "position at which the reference was set to zero; travel is counted from it"}),
    shown_in_mm({.name = "pitch", .meaning = "of the screw or of the scale, for the effect axis_periodic_error; 0: not known"}),
    shown_pure({.name = "reads_position", .meaning = "1: what is read is the actual position itself; 0: its deviation from the target"}),
    {.name = "temperature", .unit = "degC", .si_unit = "K", .default_value = chain::reference_temperature,
     .meaning = "of the axis' scale, recorded with the reading; only the effect axis_expansion reads it"},
    {.name = "pitch_angle", .unit = "urad", .si_unit = "rad", .default_value = 0,
     .meaning = "angular error of the axis at the target, measured apart; only the effect axis_abbe_error reads it"},
    {.name = "compensated", .unit = "um/m", .si_unit = "1", .default_value = 0,
     .meaning = "expansion for which the reference has reduced its indication already: coefficient times temperature difference"},
};
inline constexpr VariableCard indication_cards[] = {
    {.name = "deviation", .unit = "um", .si_unit = "m", .default_value = 0, .meaning = "actual position, by the reference, minus target; with reads_position = 1 the actual position"}};

constexpr VariableCard figure(std::string_view name, std::string_view meaning) { return {name, "um", "m", 0, meaning}; }
inline constexpr VariableCard measurand_cards[] = {
    figure("corrected_deviation", "deviation at 20 degC without the errors of the reference and those of freed effects")};

// Figures that one run in each direction gives; the others need several.
#define GUMSHOE_SYSTEMATIC                                                                                             \
  figure("E", "bidirectional systematic positioning error"), figure("E_up", "the same upwards"),                       \
  figure("E_down", "the same downwards"), figure("M", "range of the mean bidirectional positioning error"),            \
  figure("B", "reversal error: the largest of all targets, without sign"),                                             \
  figure("mean_reversal", "mean reversal error: upwards minus downwards, with sign")
inline constexpr VariableCard systematic_cards[] = {GUMSHOE_SYSTEMATIC};
inline constexpr VariableCard all_cards[] = {
    figure("A", "bidirectional accuracy of positioning"), figure("A_up", "the same upwards"),
    figure("A_down", "the same downwards"), figure("R", "bidirectional repeatability of positioning"),
    figure("R_up", "repeatability upwards"), figure("R_down", "repeatability downwards"), GUMSHOE_SYSTEMATIC};
#undef GUMSHOE_SYSTEMATIC

inline constexpr EquationCard deviation_equation{
    "corrected_deviation = deviation - reads_position * position - t * (reference_scale + cos(misalignment) - 1 + expansion * temperature_difference - "
    "compensated) - reference_drift * time + dead_path * wavelength_change", "t = position - datum"};
#define GUMSHOE_MEANS                                                                                                  \
  {"m_i = sum(x_ij) / n", "x_ij: corrected deviation at target i in run j, of each direction"},                        \
  {"E = max(m_i) - min(m_i)", "over targets and both directions; E_up, E_down: over one"},                             \
  {"B_i = u_i - d_i", "u_i, d_i: m_i upwards and downwards; B: the largest abs(B_i), mean_reversal: their mean"},      \
  {"M = max(b_i) - min(b_i)", "b_i = (u_i + d_i) / 2"}
inline constexpr EquationCard deviation_equations[] = {deviation_equation};
inline constexpr EquationCard systematic_equations[] = {GUMSHOE_MEANS, deviation_equation};
inline constexpr EquationCard all_equations[] = {
    {"s_i = sqrt(sum((x_ij - m_i)^2) / (n - 1))", "of each direction; m_i: below"},
    {"A = max(m_i + 2 * s_i) - min(m_i - 2 * s_i)", "over targets and both directions; A_up, A_down: over one"},
    {"R_i = max(2 * s_u + 2 * s_d + abs(B_i), 4 * s_u, 4 * s_d)",
     "s_u, s_d: s_i upwards and downwards; R, R_up, R_down: the largest R_i, 4 s_u, 4 s_d"},
    GUMSHOE_MEANS, deviation_equation};
#undef GUMSHOE_MEANS

inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "deviation", .meaning = "of each reading, corrected", .equations = deviation_equations},
    {.name = "iso_230_2", .meaning = "figures of ISO 230-2:2014 from two runs or more in both directions",
     .measurands = all_cards, .equations = all_equations},
    {.name = "iso_230_2_once", .meaning = "those that one run in each direction gives: without accuracy and repeatability",
     .measurands = systematic_cards, .equations = systematic_equations},
};
inline constexpr Stage stages[] = {Stage::axis};
// clang-format on

} // namespace gumshoe::models::linear_axis
