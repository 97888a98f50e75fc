#pragma once
/// Card of the scanner: quantities, conditions, measurands, evaluations.
#include "models/location_rows.h"

namespace gumshoe::models::laser_scan {

using si::deg, si::mm, si::um;

// clang-format off: a row of a card stays together
inline constexpr QuantityCard quantity_cards[] = {
    in_mm({.name = "e_x", .symbol = "e_x", .meaning = "actual place of the part minus workpiece_x"}),
    in_mm({.name = "e_y", .symbol = "e_y", .meaning = "actual place of the part minus workpiece_y"}),
    in_um({.name = "e_z", .meaning = "by how much the part sits too high"}),
    in_mrad({.name = "e_a", .limits = below_90, .symbol = "e_a", .meaning = "tilt of the part about the table's X"}),
    in_mrad({.name = "e_b", .limits = below_90, .symbol = "e_b", .meaning = "tilt of the part about the table's Y"}),
    in_mm({.name = "workpiece_x", .symbol = "q_center(1)", .meaning = "commanded centre of the part on the table"}),
    in_mm({.name = "workpiece_y", .symbol = "q_center(2)", .meaning = "commanded centre of the part on the table"}),
    GUMSHOE_LOCATION_ROWS,
    in_mrad({.name = "E_C0Y", .limits = below_90, .symbol = "gamma_YX", .meaning = "squareness of Y to X: X moves by -E_C0Y Y"}),
    in_mrad({.name = "E_A0Z", .limits = below_90, .symbol = "alpha_ZY", .meaning = "squareness of Z to Y: Y moves by -E_A0Z Z"}),
    in_mrad({.name = "E_B0Z", .limits = below_90, .symbol = "beta_ZX", .meaning = "squareness of Z to X: X moves by E_B0Z Z"}),
    in_mm({.name = "sensor_length", .limits = not_negative,
           .meaning = "from the spindle's reference point down to the commanded spot; it matters with a rotary axis in the "
                      "head, and to squareness"}),
    in_um({.name = "sensor_zero", .meaning = "indication where the surface is as far away as commanded"}),
    pure({.name = "sensor_gain", .limits = {-0.5, 0.5}, .meaning = "relative: displacement = sensor_zero + (1 + sensor_gain) "
                                                                   "actual displacement"}),
    pure({.name = "cone_slope", .default_value = -0.005, .limits = any, .symbol = "m_0",
          .meaning = "rise of the cone per radius, the tangent of its angle"}),
    in_mm({.name = "cone_radius", .default_value = 70 * mm, .symbol = "r_0", .meaning = "radius at which cone_height holds"}),
    in_mm({.name = "cone_height", .symbol = "z_0", .meaning = "of the cone at cone_radius, above the table's origin"}),
    in_mm({.name = "surface_height",
           .meaning = "of the plane at the part's centre, of the axis of a cylinder, of the centre of a sphere or torus"}),
    pure({.name = "plane_slope_x", .meaning = "rise of the plane along X"}),
    pure({.name = "plane_slope_y", .meaning = "rise of the plane along Y"}),
    in_deg({.name = "cylinder_azimuth", .meaning = "direction of the cylinder's axis, which lies level, from X"}),
    in_mm({.name = "surface_radius", .default_value = 100 * mm,
           .meaning = "of a cylinder, a sphere, or a torus' tube; negative: hollow, the beam meets the lower side"}),
    in_mm({.name = "ring_radius", .default_value = 70 * mm, .limits = positive, .meaning = "of a torus, to the middle of its tube"}),
    pure({.name = "profiles", .default_value = 1, .limits = {1, 12}, .meaning = "number of profiles that are judged apart"}),
    {.name = "form_deviation", .unit = "um", .si_unit = "m", .limits = any,
     .meaning = "true, by how much the surface is nearer than nominal along the beam; only simulation reads it"},
};
inline constexpr VariableCard condition_cards[] = {
    B_card,
    C_card,
    shown_in_mm({.name = "radius", .default_value = 70 * mm, .meaning = "of the commanded spot from the part's centre"}),
    shown_in_deg({.name = "theta", .meaning = "azimuth of the commanded spot about the part's centre, from the table's X"}),
    shown_pure({.name = "surface", .meaning = "0 cone, 1 plane, 2 cylinder, 3 sphere, 4 torus"}),
    shown_pure({.name = "profile", .default_value = 1, .meaning = "number of the profile to which the point belongs"}),
    shown_in_s({.name = "time", .meaning = "since the start of the work; used only by effects, like the conditions below"}),
    shown_pure({.name = "direction", .default_value = 1,
                .meaning = "in which the second axis scans, or was turned here: 1, -1, or 0 at rest"}),
    {.name = "speed", .unit = "deg/s", .si_unit = "rad/s", .default_value = 0,
     .meaning = "of the scan, about the second axis and about the part alike; 0 at rest"},
    shown_pure({.name = "B_direction", .default_value = 1,
                .meaning = "from which the angle of the first axis was reached: 1, -1, or 0 for neither"}),
    shown_in_deg({.name = "part_angle", .meaning = "by which the part was turned on its seat"}),
};
inline constexpr VariableCard indication_cards[] = {
    shown_in_mm({.name = "displacement", .meaning = "by how much the surface is nearer to the sensor than commanded"})};
constexpr VariableCard shown_in_um(const Variable& v) { return {v.name, "um", "m", v.default_value, v.meaning}; }
inline constexpr VariableCard measurand_cards[] = {
    shown_in_um({.name = "form_deviation", .meaning = "by how much the surface is nearer than nominal along the beam: the "
                                                      "displacement less what the quantities explain"})};

/// One row per profile: GUMSHOE_FOR_EACH_PROFILE(ROW) is ROW(1), ROW(2) ... ROW(12).
#define GUMSHOE_FOR_EACH_PROFILE(ROW)                                                                                  \
  ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10), ROW(11), ROW(12)
inline constexpr std::size_t most_profiles = 12;
#define GUMSHOE_PROFILE(k)                                                                                             \
  shown_in_um({.name = "peak_to_valley_" #k, .meaning = "largest minus smallest form deviation of profile " #k}),      \
      shown_in_um({.name = "mean_" #k, .meaning = "mean form deviation of profile " #k}),                              \
      shown_in_um({.name = "roundness_" #k,                                                                            \
                   .meaning = "largest minus smallest form deviation of profile " #k " from its fitted plane"}),       \
      in_mrad_shown({.name = "tilt_a_" #k, .meaning = "tilt about X of the plane fitted to profile " #k}),             \
      in_mrad_shown({.name = "tilt_b_" #k, .meaning = "tilt about Y of the plane fitted to profile " #k})
constexpr VariableCard in_mrad_shown(const Variable& v) { return {v.name, "mrad", "rad", v.default_value, v.meaning}; }
inline constexpr VariableCard profile_cards[] = {GUMSHOE_FOR_EACH_PROFILE(GUMSHOE_PROFILE)};
#undef GUMSHOE_PROFILE

inline constexpr EquationCard point_equations[] = {
    {"form_deviation = (displacement - sensor_zero) / (1 + sensor_gain) - t",
     "t: along the beam from the commanded spot to the nominal surface, by the machine's errors and the part's place"},
};
inline constexpr EquationCard profile_equations[] = {
    {"peak_to_valley = max(form_deviation_i) - min(form_deviation_i)", "i: reading of a profile"},
    {"sum((form_deviation_i - mean - tilt_a * y_i + tilt_b * x_i)^2) = minimum",
     "x, y: of the spot about the part's centre; roundness: largest minus smallest remainder"},
    point_equations[0],
};
inline constexpr std::string_view per_reading = "sampling_period", once = "set_up";
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "point", .meaning = "form deviation at each point", .time_per_reading = per_reading, .time_once = once,
     .equations = point_equations},
    {.name = "profile", .meaning = "peak to valley, mean, roundness and tilt of each profile, from all its points",
     .measurands = profile_cards, .time_per_reading = per_reading, .time_once = once, .equations = profile_equations},
};
inline constexpr QuantityCard timing_cards[] = {
    in_s({.name = "sampling_period", .default_value = 0.001, .limits = not_negative, .meaning = "for every reading"}),
    in_s({.name = "set_up", .default_value = 300, .limits = not_negative, .meaning = "clamping and levelling the part, once"}),
};
inline constexpr Stage stages[] = {Stage::motion, Stage::scanning, Stage::rotary, Stage::slides, Stage::surface, Stage::sensor};
// clang-format on

} // namespace gumshoe::models::laser_scan
