#pragma once
/// Joint evaluations of the sphere calibration: probe and axes from all poses together.
#include <string>
#include <vector>

#include "models/sphere_calibration/identification.h"

namespace gumshoe::models::sphere_calibration {

enum JointRow { residual_row = unknowns, rank_row, condition_row, joint_rows };

/// The eleven in the order of the published tables, then how well they are known.
inline constexpr VariableCard joint_measurands[] = {
    {"probe_x", "mm", "m", 0, "from the origin O_r to the tip's centre, along X"},
    {"probe_y", "mm", "m", 0, "from the origin O_r to the tip's centre, against Y"},
    {"probe_z", "mm", "m", 0, "from the origin O_r to the tip's centre, against Z"},
    {"E_X0B", "mm", "m", 0, "offset of the B axis along X"},
    {"E_Z0B", "mm", "m", 0, "offset of the B axis against Z"},
    {"E_A0B", "deg", "rad", 0, "squareness of B to Z"},
    {"E_C0B", "deg", "rad", 0, "squareness of B to X"},
    {"E_X0C", "mm", "m", 0, "offset of the C axis along X"},
    {"E_Y0C", "mm", "m", 0, "offset of the C axis along Y"},
    {"E_A0C", "deg", "rad", 0, "squareness of C to Y"},
    {"E_B0C", "deg", "rad", 0, "squareness of C to X"},
    {"residual_rms", "um", "m", 0, "root mean square of recorded commands less those of the identified machine"},
    {"rank", "1", "1", 0, "how many of the eleven, or of their combinations, the poses see"},
    {"condition_number", "1", "1", 0,
     "of the derivatives by the eleven, columns of length one, on what the poses see; whitened if joint_weighted"},
};
static_assert(std::size(joint_measurands) == joint_rows);
/// Row of an unknown.
inline constexpr int row_of[unknowns] = {0, 1, 2, 3, 4, 7, 8, 5, 6, 9, 10};

constexpr bool is_joint(int evaluation) { return evaluation >= variants; }

/// @param condition [reading][conditions]
Patterns patterns(const std::vector<const double*>& condition);
/// The commands of one reading by one quantity, at the declared estimates.
Vector3<double> derivative(const BlockCall& call, std::size_t reading, std::size_t quantity);
/// From what is declared of the data; throws nothing, empty rows beside `problem` if it leaves commands without noise.
Whitening whitening(const BlockCall& call, std::string& problem);

/// Model::check_readings and Model::remarks.
std::string check_readings(const BlockCall& call);
std::vector<std::string> remarks(const BlockCall& call);

} // namespace gumshoe::models::sphere
