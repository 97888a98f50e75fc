#pragma once
/// Card of the sphere model: quantities, conditions, measurands, evaluations.
#include "models/cards.h"

namespace gumshoe::models::sphere_calibration {

using si::deg, si::minute, si::mm, si::um;

// clang-format off: a row of a card stays together
inline constexpr QuantityCard quantity_cards[] = {
    in_mm({.name = "probe_x", .default_value = 85.564 * mm, .symbol = "d_rpx",
           .meaning = "position of the tip's centre from the origin O_r along X"}),
    in_mm({.name = "probe_y", .default_value = 287.428 * mm, .symbol = "d_rpy",
           .meaning = "position of the tip's centre from the origin O_r against Y"}),
    in_mm({.name = "probe_z", .default_value = 454.220 * mm, .symbol = "d_rpz",
           .meaning = "position of the tip's centre from the origin O_r against Z"}),
    in_mm({.name = "E_X0B", .default_value = -0.406 * mm, .symbol = "E_X0B",
           .meaning = "offset of the B axis: D_rbx - d_rbx, along X"}),
    in_mm({.name = "E_Z0B", .default_value = 0.544 * mm, .symbol = "E_Z0B",
           .meaning = "offset of the B axis: D_rbz - d_rbz, so against Z; minus ISO's"}),
    in_mm({.name = "E_X0C", .default_value = 0.230 * mm, .symbol = "E_X0C",
           .meaning = "offset of the C axis: D_rcx - d_rcx, along X"}),
    in_mm({.name = "E_Y0C", .default_value = 0.369 * mm, .symbol = "E_Y0C",
           .meaning = "offset of the C axis: D_rcy - d_rcy, along Y"}),
    in_deg({.name = "E_A0B", .default_value = -0.267 * deg, .limits = below_90, .symbol = "E_A0B",
            .meaning = "squareness of B to Z; b ~ (-tan E_C0B, 1, tan E_A0B)"}),
    in_deg({.name = "E_C0B", .default_value = -0.184 * deg, .limits = below_90, .symbol = "E_C0B",
            .meaning = "squareness of B to X; b ~ (-tan E_C0B, 1, tan E_A0B)"}),
    in_deg({.name = "E_A0C", .default_value = 0.0433 * deg, .limits = below_90, .symbol = "E_A0C",
            .meaning = "squareness of C to Y; c ~ (tan E_B0C, -tan E_A0C, 1)"}),
    in_deg({.name = "E_B0C", .default_value = 0.0121 * deg, .limits = below_90, .symbol = "E_B0C",
            .meaning = "squareness of C to X; c ~ (tan E_B0C, -tan E_A0C, 1)"}),
    in_mm({.name = "link_B_x", .default_value = -120 * mm, .symbol = "d_rbx",
           .meaning = "design, O_r to the B axis along X; inferred, not printed"}),
    in_mm({.name = "link_B_z", .default_value = 110 * mm, .symbol = "d_rbz",
           .meaning = "design, O_r to the B axis against Z; inferred, not printed"}),
    in_mm({.name = "link_C_x", .default_value = 50 * mm, .symbol = "d_rcx",
           .meaning = "design, O_r to the C axis along X; inferred, not printed"}),
    in_mm({.name = "link_C_y", .default_value = 180 * mm, .symbol = "d_rcy",
           .meaning = "design, O_r to the C axis along Y; inferred, not printed"}),
    in_mm({.name = "sphere_distance", .default_value = 184.183 * mm, .symbol = "d_s",
           .meaning = "distance from the flange of the A axis to the sphere's centre"}),
    in_mm({.name = "sphere_radius", .default_value = 12.5 * mm, .limits = positive, .symbol = "R_c",
           .meaning = "radius of the sphere"}),
    in_mm({.name = "tip_radius", .default_value = 3 * mm, .limits = positive, .symbol = "R_p",
           .meaning = "radius of the probe's tip"}),
    in_mm({.name = "sphere_y", .meaning = "offset of the sphere's centre from the A axis along Y at A = 0; turns with "
                                          "A"}),
    in_mm({.name = "sphere_z", .meaning = "offset of the sphere's centre from the A axis along Z at A = 0; turns with "
                                          "A"}),
    in_deg({.name = "E_AA", .symbol = "E_AA",
            .meaning = "positioning error of A; it matters only if the sphere is off the axis"}),
    in_deg({.name = "E_BB", .symbol = "E_BB", .meaning = "positioning error of B, actual minus commanded (eq 4.49)"}),
    in_deg({.name = "E_CC", .symbol = "E_CC", .meaning = "positioning error of C, actual minus commanded (eq 4.50)"}),
    in_mm({.name = "E_XX", .symbol = "E_XX", .meaning = "positioning of X; adds to the recorded X (eq 4.51)"}),
    in_mm({.name = "E_XY", .symbol = "E_XY", .meaning = "straightness of Y along X; adds to the recorded X"}),
    in_mm({.name = "E_XZ", .symbol = "E_XZ", .meaning = "straightness of Z along X; adds to the recorded X"}),
    in_mm({.name = "E_YX", .symbol = "E_YX", .meaning = "straightness of X along Y; adds to the recorded Y"}),
    in_mm({.name = "E_YY", .symbol = "E_YY", .meaning = "positioning of Y; adds to the recorded Y"}),
    in_mm({.name = "E_YZ", .symbol = "E_YZ", .meaning = "straightness of Z along Y; adds to the recorded Y"}),
    in_mm({.name = "E_ZX", .symbol = "E_ZX", .meaning = "straightness of X along Z; adds to the recorded Z"}),
    in_mm({.name = "E_ZY", .symbol = "E_ZY", .meaning = "straightness of Y along Z; adds to the recorded Z"}),
    in_mm({.name = "E_ZZ", .symbol = "E_ZZ", .meaning = "positioning of Z; adds to the recorded Z"}),
    {.name = "S_XY", .unit = "um/m", .si_unit = "rad", .limits = any, .symbol = "S_XY",
     .meaning = "squareness of Y to X: adds -S_XY times the nominal Y to the recorded X"},
    {.name = "S_XZ", .unit = "um/m", .si_unit = "rad", .limits = any, .symbol = "S_XZ",
     .meaning = "squareness of Z to X: adds S_XZ times the nominal Z to the recorded X"},
    {.name = "S_YZ", .unit = "um/m", .si_unit = "rad", .limits = any, .symbol = "S_YZ",
     .meaning = "squareness of Z to Y: adds -S_YZ times the nominal Z to the recorded Y"},
};
inline constexpr VariableCard condition_cards[] = {
    shown_in_deg({.name = "A", .meaning = "commanded angle; turns the workpiece about +X (eq 4.1)"}),
    shown_in_deg({.name = "B", .meaning = "commanded; about +Y"}),
    shown_in_deg({.name = "C", .meaning = "commanded; about +Z"}),
    shown_pure(
        {.name = "pattern",
         .meaning = "a label: 1 if C moves at B = 0, 2 if B moves at C = 90 deg; only closed_form uses it"}),
    shown_pure({.name = "repeat", .meaning = "a label: number of the repetition"}),
    shown_pure({.name = "direction", .default_value = -1, .meaning = "direction of approach along Z: -1 downwards"}),
    shown_in_s({.name = "time", .meaning = "time since the start of the work"}),
    {.name = "feed", .unit = "mm/min", .si_unit = "m/s", .default_value = 30 * mm / minute,
     .meaning = "feed of the approach; used only by effects, like the conditions below"},
    shown_pure({.name = "B_direction", .default_value = 1,
                .meaning = "direction from which B was reached: 1 upwards, -1 downwards, 0 neither"}),
    shown_pure({.name = "C_direction", .default_value = 1,
                .meaning = "direction from which C was reached: 1 upwards, -1 downwards, 0 neither"}),
    shown_pure({.name = "B_clamped", .meaning = "1 if the brake of B is closed"}),
    shown_pure({.name = "C_clamped", .meaning = "1 if the brake of C is closed"}),
};
inline constexpr VariableCard indication_cards[] = {
    shown_in_mm({.name = "X", .meaning = "command recorded at the trigger"}),
    shown_in_mm({.name = "Y", .meaning = "command recorded at the trigger"}),
    shown_in_mm({.name = "Z", .meaning = "command recorded at the trigger"}),
};
inline constexpr VariableCard measurand_cards[] = {
    shown_in_mm(
        {.name = "tip_x", .meaning = "position of the tip's centre by X, Y, Z, from the flange of the A axis along X"}),
    shown_in_mm({.name = "tip_y", .meaning = "position of the tip's centre by X, Y, Z, from the A axis along Y"}),
    shown_in_mm({.name = "tip_z", .meaning = "position of the tip's centre by X, Y, Z, from the A axis along Z"}),
};
/// The eleven in the order of the published tables, then how well they are known.
inline constexpr VariableCard joint_cards[] = {
    shown_in_mm({.name = "probe_x", .meaning = "position of the tip's centre from the origin O_r along X"}),
    shown_in_mm({.name = "probe_y", .meaning = "position of the tip's centre from the origin O_r against Y"}),
    shown_in_mm({.name = "probe_z", .meaning = "position of the tip's centre from the origin O_r against Z"}),
    shown_in_mm({.name = "E_X0B", .meaning = "offset of the B axis along X"}),
    shown_in_mm({.name = "E_Z0B", .meaning = "offset of the B axis against Z"}),
    shown_in_deg({.name = "E_A0B", .meaning = "squareness of B to Z"}),
    shown_in_deg({.name = "E_C0B", .meaning = "squareness of B to X"}),
    shown_in_mm({.name = "E_X0C", .meaning = "offset of the C axis along X"}),
    shown_in_mm({.name = "E_Y0C", .meaning = "offset of the C axis along Y"}),
    shown_in_deg({.name = "E_A0C", .meaning = "squareness of C to Y"}),
    shown_in_deg({.name = "E_B0C", .meaning = "squareness of C to X"}),
    {.name = "residual_rms", .unit = "um", .si_unit = "m", .default_value = 0,
     .meaning = "root mean square difference between the recorded commands and those of the identified machine"},
    shown_diagnostic({.name = "rank", .meaning = "number of the eleven unknowns, or combinations, that the poses determine"}),
    shown_diagnostic({.name = "condition_number",
                .meaning = "of the derivatives by the eleven, columns of length one, on what the poses see; whitened "
                           "if joint_weighted"}),
};
/// How the probe is computed at each reading; then the joint evaluations.
enum Evaluation { exact, small_angle, closed_form, sequential, joint, joint_weighted };
constexpr bool is_joint(int evaluation) { return evaluation >= sequential; }
#define GUMSHOE_TIP "tip = command - e + D_B + Q_B * (D_C - D_B + Q_C * (probe - D_C))"
#define GUMSHOE_SYMBOLS                                                                                                \
  "command: (X, Y, Z); e: errors of the slides; D: place of a rotary axis, its link plus its errors; Q: turn about it by " \
  "B or C"
inline constexpr EquationCard exact_equations[] = {{GUMSHOE_TIP, GUMSHOE_SYMBOLS}};
inline constexpr EquationCard small_equations[] = {{GUMSHOE_TIP, GUMSHOE_SYMBOLS ", to first order in its orientation"}};
inline constexpr EquationCard plane_equations[] = {
    {"sum(distance_i^2) = minimum", "i: reading; distance: of the tip from a plane square to B or C, for its orientation"},
    {"sum(norm(tip_i - t)^2) = minimum", "for the seven lengths; t: tip above the sphere, from d_s, R_c and R_p"},
    exact_equations[0],
};
inline constexpr EquationCard joint_equations[] = {
    {"sum(norm(tip_i - t)^2) = minimum",
     "i: reading; for all eleven unknowns; t: tip above the sphere, from d_s, R_c and R_p"},
    exact_equations[0],
};
inline constexpr EquationCard weighted_equations[] = {
    {"v^T * V^(-1) * v = minimum",
     "v: tip minus its place above the sphere, of all readings; V: covariance matrix that the scenario declares"},
    exact_equations[0],
};
#undef GUMSHOE_SYMBOLS
#undef GUMSHOE_TIP
inline constexpr EvaluationCard evaluation_cards[] = {
    {.name = "exact", .meaning = "exact rotations about the actual axes", .equations = exact_equations},
    {.name = "small_angle",
     .meaning = "the thesis' product (4.7) to (4.10); for the reproduction study, 12 to 20 um off",
     .equations = small_equations},
    {.name = "closed_form",
     .meaning = "eqs 4.23 to 4.25 at B = 0 and 4.30 to 4.38, corrected, at C = 90 deg; for the reproduction study",
     .equations = small_equations},
    {.name = "sequential",
     .meaning = "orientations by planes through each pattern's poses, then the seven lengths by linear least squares",
     .measurands = joint_cards, .equations = plane_equations},
    {.name = "joint",
     .meaning = "all eleven unknowns by least squares, with equal weights of all commands", .measurands = joint_cards, .equations = joint_equations},
    {.name = "joint_weighted",
     .meaning = "all eleven unknowns by least squares, weighted with the covariance matrix that the scenario declares",
     .measurands = joint_cards, .equations = weighted_equations},
};
inline constexpr AxisCard axis_cards[] = {
    {"X", true, false, 0, {}},
    {"A", true, true, 0, {}},
    {"Y", false, false, 1, {}},
    {"Z", false, false, 2, {}},
    {"B", false, true, 1, {-120 * mm, 0, -110 * mm}},
    {"C", false, true, 2, {50 * mm, 180 * mm, 0}},
};
inline constexpr Stage stages[] = {Stage::motion, Stage::rotary, Stage::slides, Stage::contact, Stage::trigger};
// clang-format on

} // namespace gumshoe::models::sphere_calibration
