#pragma once
/// Card of the laser ball bars: quantities, conditions, indications, measurands, evaluations.
#include "models/location_rows.h"

namespace gumshoe::models::laser_ball_bar {

using si::deg, si::minute, si::mm;

// clang-format off: a row of a card stays together
constexpr QuantityCard base_length(std::string_view name, std::string_view symbol, std::string_view meaning) {
  return in_mm({.name = name, .default_value = 400 * mm, .limits = positive, .symbol = symbol, .meaning = meaning});
}
constexpr QuantityCard in_um(std::string_view name, std::string_view meaning) {
  return in_units({.name = name, .meaning = meaning}, "um", "m");
}
constexpr QuantityCard axis_offset(std::string_view name, std::string_view meaning) {
  return in_mm({.name = name, .limits = not_negative, .meaning = meaning});
}
constexpr QuantityCard skew(std::string_view name, std::string_view meaning) {
  return in_units({.name = name, .limits = {-1, 1}, .meaning = meaning}, "us", "s");
}
inline constexpr QuantityCard quantity_cards[] = {
    base_length("base_length_1", "L_B1", "distance from socket 1 to socket 2, as measured"),
    base_length("base_length_2", "L_B2", "distance from socket 2 to socket 3, as measured"),
    base_length("base_length_3", "L_B3", "distance from socket 3 to socket 1, as measured"),
    pure({.name = "Z_motion_x", .symbol = "n_z",
          .meaning = "direction of a Z motion in the frame of the bars, of any length: component along socket 1 to socket 2"}),
    pure({.name = "Z_motion_y", .symbol = "n_z", .meaning = "component in the sockets' plane, towards socket 3"}),
    pure({.name = "Z_motion_z", .default_value = 1, .symbol = "n_z", .meaning = "component square to the sockets' plane, towards the tool"}),
    pure({.name = "X_motion_x", .default_value = 1, .symbol = "V_x",
          .meaning = "direction of an X motion likewise; the machine's X is its part square to Z_motion"}),
    pure({.name = "X_motion_y", .symbol = "V_x", .meaning = "as Z_motion_y"}),
    pure({.name = "X_motion_z", .symbol = "V_x", .meaning = "as Z_motion_z"}),
    in_mm({.name = "origin_x", .default_value = 200 * mm, .meaning = "commanded point 0, 0, 0 from socket 1, along the machine's X"}),
    in_mm({.name = "origin_y", .default_value = 120 * mm, .meaning = "commanded point 0, 0, 0 from socket 1, along the machine's Y"}),
    in_mm({.name = "origin_z", .default_value = 300 * mm, .meaning = "commanded point 0, 0, 0 from socket 1, along the machine's Z"}),
    in_um("initialisation_1", "error of bar 1 from its initialisation, as read minus true; adds to every length"),
    in_um("initialisation_2", "the same of bar 2"),
    in_um("initialisation_3", "the same of bar 3"),
    in_mm({.name = "fixture_length_12", .default_value = 400 * mm, .limits = positive,
           .meaning = "distance of sockets 1 and 2 of the initialisation fixture along its line"}),
    in_mm({.name = "fixture_length_23", .default_value = 400 * mm, .limits = positive,
           .meaning = "distance of sockets 2 and 3 of the initialisation fixture along its line"}),
    in_mm({.name = "fixture_offset", .symbol = "h",
           .meaning = "of the fixture's middle socket from the line through the others; all bars then read short"}),
    in_um("form_1", "form error of the spheres of bar 1 where it touches them; adds to the length"),
    in_um("form_2", "the same of bar 2"),
    in_um("form_3", "the same of bar 3"),
    axis_offset("axis_offset_1", "distance of the spheres' centres across the beam of bar 1, which reads the part along its beam"),
    axis_offset("axis_offset_2", "the same of bar 2"),
    axis_offset("axis_offset_3", "the same of bar 3"),
    in_units({.name = "wavelength_error", .limits = {-1e-2, 1e-2},
              .meaning = "all lengths are read too long by this share: as initialised, a bar has counted its whole length"}, "um/m", "1"),
    in_units({.name = "expansion", .default_value = 11.5e-6, .limits = {-1e-4, 1e-4},
              .meaning = "coefficient of linear thermal expansion of what carries the sockets"}, "um/m/K", "1/K"),
    in_units({.name = "temperature_difference", .limits = {-200, 200},
              .meaning = "temperature of what carries the sockets, now minus when the base lengths were measured"}, "K", "K"),
    skew("skew_1", "moment at which bar 1 is read minus the commanded one"),
    skew("skew_2", "the same of bar 2"),
    skew("skew_3", "the same of bar 3"),
    in_units({.name = "loop_gain", .default_value = 30, .limits = {1, 1e4}, .symbol = "K",
              .meaning = "position loop gain of the slides, a feed over its following error; used in simulation, and with skews or effects"}, "1/s", "1/s"),
    pure({.name = "damping", .default_value = 0.7, .limits = {0.05, 20},
          .meaning = "damping of a slide's position loop; only a second-order servo has it"}),
    in_mm({.name = "tool_length", .limits = not_negative,
           .meaning = "from the spindle's reference point down to the tool; it matters with a rotary axis in the head"}),
    GUMSHOE_LOCATION_ROWS,
};
inline constexpr VariableCard condition_cards[] = {
    shown_pure({.name = "contour", .meaning = "0: a point at x, y, z; 1: a line from there; 2: a circle about it, or a helix; 3: a regular polygon that starts there"}),
    shown_in_mm({.name = "x", .meaning = "commanded, in the frame of the table: the point, the start of the line or polygon, or the circle's centre"}),
    shown_in_mm({.name = "y", .meaning = "likewise"}),
    shown_in_mm({.name = "z", .meaning = "likewise"}),
    shown_in_mm({.name = "size", .default_value = 100 * mm, .meaning = "length of the line or of a polygon's side, radius of the circle"}),
    shown_in_deg({.name = "angle", .meaning = "azimuth of the line, or of the polygon's first side, from +X towards +Y; the circle starts there"}),
    shown_in_deg({.name = "elevation", .meaning = "by which the line, the polygon's first side, or the circle's plane at its start rises"}),
    shown_pure({.name = "sense", .default_value = 1, .meaning = "1: a circle or polygon runs counter-clockwise, seen from above; -1: clockwise"}),
    {.name = "feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 889 * mm / minute, .meaning = "commanded along the contour"},
    {.name = "acceleration", .unit = "m/s2", .si_unit = "m/s2", .default_value = 0.98, .meaning = "commanded along the contour, from rest and to rest"},
    {.name = "jerk", .unit = "m/s3", .si_unit = "m/s3", .default_value = 0, .meaning = "limit along the contour; 0: none, a trapezoidal feed"},
    shown_pure({.name = "order", .default_value = 1, .meaning = "of the slides' servos: 1 or 2"}),
    shown_in_s({.name = "time", .meaning = "since the start of the contour"}),
    shown_in_s({.name = "contour_start", .meaning = "start of the contour since the start of the work"}),
    shown_in_s({.name = "settling", .default_value = 0.2, .meaning = "joint evaluations of a contour use readings later than this in its stretch of constant feed"}),
    shown_pure({.name = "motion", .meaning = "a label that only machine_frame reads: 3 for points along Z, 1 for points along X, else 0"}),
    shown_pure({.name = "sides", .default_value = 4, .meaning = "of a polygon, 3 to 12"}),
    shown_in_s({.name = "dwell", .meaning = "of a polygon: pause at a corner, where the command has stopped"}),
    shown_pure({.name = "turns", .default_value = 1, .meaning = "of a circle or helix"}),
    shown_in_mm({.name = "rise", .meaning = "of a circle, per turn: not 0 for an upright helix"}),
    B_card,
    C_card,
};
inline constexpr VariableCard indication_cards[] = {
    shown_in_mm({.name = "length_1", .meaning = "read of bar 1, from socket 1 to the tool"}),
    shown_in_mm({.name = "length_2", .meaning = "read of bar 2, from socket 2 to the tool"}),
    shown_in_mm({.name = "length_3", .meaning = "read of bar 3, from socket 3 to the tool"}),
};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_mm({.name = "tool_x", .meaning = "position of the tool from socket 1 along the machine's X"}),
    shown_in_mm({.name = "tool_y", .meaning = "position of the tool from socket 1 along the machine's Y"}),
    shown_in_mm({.name = "tool_z", .meaning = "position of the tool from socket 1 along the machine's Z"}),
    shown_in_mm({.name = "contour_error", .meaning = "of the tool in the contour's plane: outwards from a circle or polygon, to the left of a line"}),
    shown_in_mm({.name = "plane_error", .meaning = "of the tool out of the contour's plane, upwards"}),
    shown_in_mm({.name = "following_error", .meaning = "by which the command is ahead of the tool along the contour"}),
};
inline constexpr VariableCard frame_cards[] = {
    shown_pure({.name = "Z_motion_x", .meaning = "best line through the points along Z, a unit vector in the frame of the bars"}),
    shown_pure({.name = "Z_motion_y", .meaning = "its second component"}),
    shown_pure({.name = "Z_motion_z", .meaning = "its third component"}),
    shown_pure({.name = "X_motion_x", .meaning = "best line through the points along X, likewise"}),
    shown_pure({.name = "X_motion_y", .meaning = "its second component"}),
    shown_pure({.name = "X_motion_z", .meaning = "its third component"}),
    {.name = "E_B0X", .unit = "um/m", .si_unit = "rad", .default_value = 0, .meaning = "squareness of X to Z: positive if X drops"},
};
inline constexpr VariableCard peak_to_valley =
    shown_in_mm({.name = "peak_to_valley", .meaning = "largest minus smallest contour error at constant feed"});
inline constexpr VariableCard line_cards[] = {
    shown_in_mm({.name = "steady_offset", .meaning = "mean contour error at constant feed"}),
    peak_to_valley,
    shown_in_mm({.name = "following_error", .meaning = "its mean at constant feed"}),
};
inline constexpr VariableCard circle_cards[] = {
    shown_in_mm({.name = "steady_offset", .meaning = "mean contour error at constant feed: radius of the circle, actual minus commanded"}),
    peak_to_valley,
    shown_in_mm({.name = "major_axis", .meaning = "longer semi-axis of the ellipse through the readings at constant feed"}),
    shown_in_mm({.name = "minor_axis", .meaning = "its shorter semi-axis"}),
    shown_in_mm({.name = "axis_difference", .meaning = "major_axis minus minor_axis"}),
    shown_in_deg({.name = "major_angle", .meaning = "azimuth of the major axis in the circle's plane, as `angle` counts: -90 to 90 deg"}),
};
inline constexpr VariableCard polygon_cards[] = {
    shown_in_mm({.name = "corner_error", .meaning = "distance at which the tool passes a corner between two sides; of the worst corner"}),
    shown_in_mm({.name = "overshoot", .meaning = "largest contour error outwards"}),
    shown_in_mm({.name = "undershoot", .meaning = "largest contour error inwards"}),
};
enum Evaluation { full, commanded, machine_frame, line, circle, polygon };
inline constexpr EquationCard full_equations[] = {
    {"x = (L_1^2 - L_2^2 + L_B1^2) / (2 * L_B1)", "x, y, z: in the frame of the bars; L_i: lengths, corrected"},
    {"y = (L_1^2 - L_3^2 + L_B3^2 - 2 * x * x_3) / (2 * y_3)", "x_3, y_3: place of socket 3, from the base lengths"},
    {"z = sqrt(L_1^2 - x^2 - y^2)"},
    {"tool = R * (x, y, z)", "R: rows n_x, n_y, n_z; n_z along Z_motion, n_y along n_z x X_motion, n_x = n_y x n_z"},
};
inline constexpr EquationCard commanded_equations[] = {{"tool = origin + command"}};
inline constexpr EquationCard frame_equations[] = {
    {"sum(distance_i^2) = minimum", "i: points of a motion; distance: of the tool from its line"},
    {"sin(E_B0X) = -sum(X_motion_j * Z_motion_j)", "j: components"},
};
inline constexpr EquationCard line_equations[] = {{"steady_offset = sum(contour_error_i) / n", "i: the n readings at constant feed"}};
inline constexpr EquationCard circle_equations[] = {
    {"sum(norm(tool_i - centre - a * cos(phi_i) - b * sin(phi_i))^2) = minimum",
     "i: readings at constant feed; phi: commanded angle; centre, a, b: in the circle's plane; the axes are those of this ellipse"},
};
inline constexpr EquationCard polygon_equations[] = {
    {"corner_error = max(norm(way - corner_k))", "k: corners between two sides; way: its nearest point, straight from reading to reading"},
};
inline constexpr std::string_view per_reading = "0 * retract", once = "size / feed + retract";
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "full", .meaning = "trilateration from three bars at once, Schmitz and Ziegert 1999",
     .time_per_reading = per_reading, .time_once = once, .equations = full_equations},
    {.name = "commanded", .meaning = "no bars: the tool is taken to be where it was commanded; its error is the machine's",
     .time_per_reading = per_reading, .time_once = once, .equations = commanded_equations},
    {.name = "machine_frame", .meaning = "directions of Z and X from points along them: appendix A",
     .measurands = frame_cards, .equations = frame_equations},
    {.name = "line", .meaning = "what a line shows at constant feed", .measurands = line_cards,
     .time_per_reading = per_reading, .time_once = once, .equations = line_equations},
    {.name = "circle", .meaning = "what a circle shows at constant feed", .measurands = circle_cards,
     .time_per_reading = per_reading, .time_once = "2 * pi * turns * size / feed + retract", .equations = circle_equations},
    {.name = "polygon", .meaning = "how a polygon's corners are passed", .measurands = polygon_cards,
     .time_per_reading = per_reading, .time_once = "sides * (size / feed + dwell) + retract", .equations = polygon_equations},
};
inline constexpr QuantityCard timing_cards[] = {
    in_s({.name = "retract", .default_value = 2, .limits = not_negative, .meaning = "return to the contour's start, once"}),
};
inline constexpr Stage stages[] = {Stage::motion, Stage::slides, Stage::slide_directions, Stage::contouring};
// clang-format on

} // namespace gumshoe::models::laser_ball_bar
