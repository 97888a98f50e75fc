#pragma once
/// Values in SI of the units that cards and constants are written in: 5 * si::mm is 0.005 m.
#include <numbers>

namespace gumshoe::si {

inline constexpr double mm = 1e-3, um = 1e-6;                  ///< m
inline constexpr double deg = std::numbers::pi / 180;          ///< rad
inline constexpr double minute = 60, hour = 3600, ms = 1e-3;   ///< s
inline constexpr double rpm = 2 * std::numbers::pi / minute;   ///< rad/s

} // namespace gumshoe::si
