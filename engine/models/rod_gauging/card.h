#pragma once
/// Card of the rod model: quantities, conditions, measurands, evaluations.
#include "models/laser_setter.h"

namespace gumshoe::models::rod_gauging {

using si::deg, si::minute, si::mm;

// clang-format off: a row of a card stays together
inline constexpr QuantityCard quantity_cards[] = {
    in_mm({.name = "rod_radius", .default_value = 5 * mm, .limits = positive, .symbol = "R_r",
           .meaning = "radius of the rod's cylinder"}),
    in_mm({.name = "fillet_radius", .default_value = 0.03 * mm, .limits = not_negative, .symbol = "R_f",
           .meaning = "radius of the rounding between cylinder and bottom; at most rod_radius (ball end)"}),
    in_deg({.name = "bottom_elevation", .default_value = 90 * deg, .limits = {0, 180 * deg, true, true},
            .symbol = "phi",
            .meaning = "elevation of the bottom plane's normal; 90 deg is a square end"}),
    in_deg({.name = "bottom_azimuth", .symbol = "tau",
            .meaning = "azimuth of the bottom plane's normal in the tool-holder frame"}),
    in_mm({.name = "rod_length", .default_value = 150 * mm, .limits = positive, .symbol = "L_r",
           .meaning = "distance from the spindle reference point to the centre of the bottom, at 20 degC"}),
    in_deg({.name = "holder_angle", .symbol = "theta_th", .meaning = "angle from machine X to the X axis of the tool "
                                                                     "holder"}),
    laser_setter::beam_yaw,
    laser_setter::beam_pitch,
    laser_setter::beam_radius,
    laser_setter::trigger_fraction,
    in_mm({.name = "laser_z", .symbol = "Z_ts",
           .meaning = "true height of the beam's axis where it passes the spindle axis; used only in simulation"}),
};
inline constexpr VariableCard condition_cards[] = {
    {.name = "feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 4 * mm / minute,
     .meaning = "feed of the spindle towards the beam"},
    laser_setter::time,
    laser_setter::direction,
};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_mm({.name = "bottom_height",
                 .meaning = "height of the bottom's centre above the beam's axis at the trigger, Z'_d"}),
    shown_in_mm({.name = "laser_z",
                 .meaning = "height of the beam's axis where it passes the spindle axis: spindle_z - rod_length - "
                            "bottom_height"}),
};
inline constexpr EquationCard full_equations[] = {
    {"laser_z = spindle_z - rod_length - bottom_height"},
    {"covered(bottom_height) = trigger_fraction",
     "covered: share of the beam's cross-section in the rod's shadow, from the geometry of rod and beam"},
};
inline constexpr EquationCard conventional_equations[] = {{"laser_z = spindle_z - rod_length"}, {"bottom_height = 0"}};
enum Evaluation { full, conventional };
inline constexpr std::string_view per_reading = "approach / feed + retract", once = "rod_change";
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "full",
     .meaning = "exact geometry of rod and beam: Fang 2022, section 2.4",
     .time_per_reading = per_reading,
     .time_once = once,
     .equations = full_equations},
    {.name = "conventional",
     .meaning = "square rod and aligned beam, bottom_height = 0: the geometry is ignored",
     .time_per_reading = per_reading,
     .time_once = once,
     .equations = conventional_equations},
};
inline constexpr QuantityCard timing_cards[] = {
    in_mm({.name = "approach", .default_value = 2 * mm, .limits = not_negative,
           .meaning = "distance at the feed before the trigger"}),
    in_s({.name = "retract", .default_value = 2, .limits = not_negative,
          .meaning = "retraction at rapid and settling, for every reading"}),
    in_s({.name = "rod_change", .default_value = 60, .limits = not_negative,
          .meaning = "mounting the rod and moving over the beam, once"}),
};
inline constexpr Stage stages[] = {Stage::standing, Stage::pose, Stage::motion, Stage::trigger};
// clang-format on

} // namespace gumshoe::models::rod_gauging
