#pragma once
/// The value of a figure that there is none of, and of a limit that limits nothing.
#include <limits>

namespace gumshoe {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace gumshoe
