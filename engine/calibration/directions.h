#pragma once
/// Directions that data cannot see, in words.
#include <string>
#include <vector>

#include "calibration/data.h"
#include "math/parameter_covariance.h"

namespace gumshoe::calibration {

/// "laser_z is indistinguishable from rod_length (laser_z +1 mm and rod_length -1 mm leave every indication as it is)";
/// "the indications do not depend on beam_yaw".
std::string in_words(const least_squares::Direction& direction, const std::vector<Unknown>& unknowns);

/// The names of its members, the largest first.
std::vector<std::string> members(const least_squares::Direction& direction, const std::vector<Unknown>& unknowns);

} // namespace gumshoe::calibration
