#pragma once
/// Directions that data cannot see, in words.
#include <string>
#include <vector>

#include "math/parameter_covariance.h"

namespace gumshoe::least_squares {

struct Parameter {
  std::string name, unit, si_unit;
};

/// "laser_z is indistinguishable from rod_length (laser_z +1 mm and rod_length -1 mm leave every indication unchanged)";
/// "the indications do not depend on beam_yaw".
std::string in_words(const Direction& direction, const std::vector<Parameter>& parameters);

/// The names of its members, the largest first.
std::vector<std::string> members(const Direction& direction, const std::vector<Parameter>& parameters);

} // namespace gumshoe::least_squares
