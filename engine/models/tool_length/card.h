#pragma once
/// Card of the mill model: quantities, conditions, measurands, evaluations, times.
#include "chain/turning_tool.h"
#include "models/laser_setter.h"

namespace gumshoe::models::tool_length {

using si::deg, si::minute, si::mm, si::rpm;

// Their limits hold with the errors of every insert, too.
// clang-format off: a row of a card stays together
inline constexpr QuantityCard tool_radius =
    in_mm({.name = "tool_radius", .default_value = 10 * mm, .limits = positive, .symbol = "r",
           .meaning = "distance from the tool's axis to the virtual cutting point of an insert"});
inline constexpr QuantityCard insert_radius = in_mm({.name = "insert_radius",
                                                     .default_value = 6 * mm,
                                                     .limits = positive,
                                                     .symbol = "R",
                                                     .meaning = "radius of the round cutting edge"});
inline constexpr QuantityCard insert_axial_angle = in_deg({.name = "insert_axial_angle",
                                                           .default_value = -5 * deg,
                                                           .limits = below_90,
                                                           .symbol = "theta_a",
                                                           .meaning = "axial angle of the rake face"});
#define GUMSHOE_WEAR(k)                                                                                                \
  in_mm({.name = "wear_" #k, .symbol = "W_" #k, .meaning = "flute " #k " is shorter by this; ignored beyond `inserts`"})
inline constexpr QuantityCard quantity_cards[] = {
    tool_radius,
    insert_radius,
    in_mm({.name = "insert_thickness", .default_value = 3.97 * mm, .limits = not_negative, .symbol = "d_i",
           .meaning = "distance from the rake face to the far end of the flank"}),
    in_deg({.name = "clearance_angle", .default_value = 15 * deg, .limits = {0, 90 * deg, false, true},
            .symbol = "tau",
            .meaning = "clearance angle of the conical flank"}),
    in_deg({.name = "insert_radial_angle", .default_value = -8 * deg, .limits = {-90 * deg, 90 * deg},
            .symbol = "theta_r",
            .meaning = "radial angle of the rake face"}),
    insert_axial_angle,
    pure({.name = "inserts", .default_value = 2, .limits = {1, chain::most_inserts},
          .symbol = "n",
          .meaning = "number of evenly spaced inserts; an integer"}),
    GUMSHOE_FOR_EACH_INSERT(GUMSHOE_WEAR),
    in_deg({.name = "holder_angle", .symbol = "theta_t", .meaning = "angle from the spindle's X axis to the first "
                                                                    "insert"}),
    in_mm({.name = "tool_length", .default_value = 150 * mm, .limits = positive, .symbol = "L_t",
           .meaning = "distance from the spindle reference point to the centre of the unworn tool; used only in "
                      "simulation"}),
    in_mm({.name = "offset", .default_value = 4 * mm, .symbol = "d",
           .meaning = "lateral offset d of the spindle axis from the beam; the axis is at Y = -d"}),
    laser_setter::beam_yaw,
    laser_setter::beam_pitch,
    laser_setter::beam_radius,
    laser_setter::trigger_fraction,
    in_mm({.name = "laser_z", .symbol = "Z_ts", .meaning = "height of the beam's axis, from its calibration"}),
};
#undef GUMSHOE_WEAR
inline constexpr VariableCard condition_cards[] = {
    {.name = "spindle_speed", .unit = "rpm", .si_unit = "rad/s", .default_value = 1000 * rpm,
     .meaning = "spindle speed, counter-clockwise seen from above"},
    {.name = "feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 30 * mm / minute,
     .meaning = "feed of the spindle towards the beam"},
    shown_in_deg({.name = "start_angle", .meaning = "spindle angle when the feed begins"}),
    shown_in_mm({.name = "start_height", .default_value = 5 * mm,
                 .meaning = "height of the tool's centre above the beam's axis when the feed begins"}),
    laser_setter::time,
    laser_setter::direction,
};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_mm({.name = "trigger_height",
                 .meaning = "height of the unworn tool's centre above the beam's axis at the trigger, Z_t"}),
    shown_in_mm(
        {.name = "tool_length", .meaning = "length to the centre of the unworn tool: spindle_z - laser_z - "
                                           "trigger_height"}),
    shown_in_mm({.name = "effective_length", .meaning = "length of the longest flute: tool_length minus the smallest "
                                                        "wear"}),
};

// Joint evaluations.
inline constexpr VariableCard joint_length = shown_in_mm(
                                  {.name = "tool_length",
                                   .meaning =
                                       "length to the centre of the unworn tool: effective_length plus the smallest "
                                       "declared wear"}),
                              joint_effective = shown_in_mm({.name = "effective_length",
                                                             .meaning = "length of the longest flute that the "
                                                                        "readings determine"});
#define GUMSHOE_FLUTE(k)                                                                                               \
  shown_in_mm({.name = "flute_length_" #k,                                                                             \
               .meaning = "length of flute " #k "; for a hidden flute the largest that the readings allow"}),          \
      shown_in_mm(                                                                                                     \
          {.name = "wear_difference_" #k, .meaning = "longest flute minus this one; for a hidden flute at least"}),    \
      shown_diagnostic({.name = "seen_" #k, .meaning = "1: the readings determine this flute; 0: it is hidden"})
inline constexpr VariableCard length_cards[] = {joint_length, joint_effective};
inline constexpr VariableCard curve_cards[] = {
    joint_length,
    joint_effective,
    shown_in_deg({.name = "phase",
                  .meaning = "angle from the spindle's X axis to the longest flute, if start_height is correct: a "
                             "micrometre changes "
                             "it by several degrees"}),
    shown_diagnostic({.name = "seen_flutes", .meaning = "number of flutes that the readings determine"}),
    {.name = "residual_rms", .unit = "um", .si_unit = "m", .default_value = 0,
     .meaning = "root mean square difference between readings and fitted curve"},
    shown_diagnostic({.name = "degrees_of_freedom", .meaning = "readings minus determined flutes minus one for the phase"}),
    GUMSHOE_FOR_EACH_INSERT(GUMSHOE_FLUTE)};
inline constexpr VariableCard peak_cards[] = {
    joint_length, joint_effective, shown_diagnostic({.name = "peaks", .meaning = "number of local maxima of the connected "
                                                                           "readings"}),
    GUMSHOE_FOR_EACH_INSERT(GUMSHOE_FLUTE)};
#undef GUMSHOE_FLUTE

// One reading: the spindle comes to speed, the tool is fed into the beam and retracted. An oriented tool stops first.
#define GUMSHOE_RUN "spindle_speed/spindle_acceleration + start_height/feed + start_height/rapid_feed"
inline constexpr std::string_view per_run = GUMSHOE_RUN, per_oriented_run = "orientation_time + " GUMSHOE_RUN,
                                  once = "2*approach_distance/rapid_feed + safety_time";
#undef GUMSHOE_RUN
inline constexpr QuantityCard timing_cards[] = {
    {.name = "rapid_feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 10000 * mm / minute, .limits = positive,
     .meaning = "rapid feed of approach and retraction"},
    in_mm({.name = "approach_distance", .default_value = 200 * mm, .limits = not_negative,
           .meaning = "distance from the waiting position to a point above the beam; travelled twice"}),
    in_s({.name = "orientation_time", .default_value = 1, .limits = not_negative,
          .meaning = "time to stop the spindle at the start angle"}),
    {.name = "spindle_acceleration",
     .unit = "rad/s2",
     .si_unit = "rad/s2",
     .default_value = 200,
     .limits = {0, 1e6, true},
     .meaning = "acceleration of the spindle to its speed"},
    in_s({.name = "safety_time", .default_value = 2, .limits = not_negative,
          .meaning = "time for checks of the tool setter, dwell and air blast"}),
};
inline constexpr EquationCard full_equations[] = {
    {"tool_length = spindle_z - laser_z - trigger_height"},
    {"effective_length = tool_length - min(wear)"},
    {"covered(trigger_height) = trigger_fraction",
     "covered: largest share of the beam's cross-section in the shadow of a turning insert; trigger_height: the first "
     "height at which it holds"},
};
inline constexpr EquationCard conventional_equations[] = {{"tool_length = spindle_z - laser_z"},
                                                          {"trigger_height = 0"}};
inline constexpr EquationCard single_equations[] = {{"effective_length = spindle_z - laser_z"},
                                                    {"tool_length = effective_length + min(wear)"}};
inline constexpr EquationCard curve_equations[] = {
    {"spindle_z_i - laser_z = max(H_k + F_k(c_i + d * phi_k + u - H_k))",
     "i: reading; k: flute; H: height of a flute; F: trigger height of an unworn flute; c: start height and angle; d: "
     "drop per angle; phi: azimuth of the flute; u: phase. H and u by least squares"},
    {"effective_length = max(H_k)"},
    {"tool_length = effective_length + min(wear)"},
};
inline constexpr EquationCard peak_equations[] = {
    {"effective_length = max(spindle_z_i) - laser_z", "i: reading; the highest peaks are the flutes"},
    {"tool_length = effective_length + min(wear)"},
};
enum Evaluation { full, conventional, single, slow, characteristic_curve, peaks };
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "full",
     .meaning = "exact trigger of the turning tool: Fang 2022, chapter 3",
     .equations = full_equations},
    {.name = "conventional",
     .meaning = "trigger_height = 0, the reading minus the laser's height: the geometry is ignored",
     .equations = conventional_equations},
    {.name = "single",
     .meaning =
         "one reading at any start angle, without a known curve: effective_length is the reading minus the laser's "
         "height",
     .measurands = length_cards,
     .time_per_reading = per_run,
     .time_once = once,
     .equations = single_equations},
    {.name = "slow",
     .meaning = "the same at high spindle speed and low feed",
     .measurands = length_cards,
     .time_per_reading = per_run,
     .time_once = once,
     .equations = single_equations},
    {.name = "characteristic_curve",
     .meaning = "readings at several start angles: fits the model's curve and its phase",
     .measurands = curve_cards,
     .time_per_reading = per_oriented_run,
     .time_once = once,
     .equations = curve_equations},
    {.name = "peaks",
     .meaning =
         "readings at several start angles, connected by lines: the highest peaks are the flutes (Fang 2022, 3.5.2)",
     .measurands = peak_cards,
     .time_per_reading = per_oriented_run,
     .time_once = once,
     .equations = peak_equations},
};
inline constexpr Stage stages[] = {Stage::pose,   Stage::insert, Stage::spindle,
                                   Stage::motion, Stage::timing, Stage::trigger};
// clang-format on

} // namespace gumshoe::models::tool_length
