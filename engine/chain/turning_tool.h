#pragma once
/// What effects may do to a tool that turns: to its spindle, to the moments at which things happen, to how it sits and
/// to each insert. All fields are deviations with 0 for none, but for those that are commanded.
#include <array>

#include "chain/probing_event.h"

/// One row per insert: GUMSHOE_FOR_EACH_INSERT(ROW) is ROW(1), ROW(2) ... ROW(12).
#define GUMSHOE_FOR_EACH_INSERT(ROW)                                                                                   \
  ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10), ROW(11), ROW(12)

namespace gumshoe::chain {

inline constexpr int most_inserts = 12;

template <class T> struct InsertDeviation {
  T radius = T(0.0);                             ///< of the cutting edge; the virtual cutting point stays, m
  T tool_radius = T(0.0);                        ///< m
  T azimuth = T(0.0);                            ///< of the seat, rad
  T radial_angle = T(0.0), axial_angle = T(0.0); ///< rad
};

template <class T> struct TurningTool {
  // spindle
  T speed = T(0.0); ///< rad/s: commanded, then true
  // timing
  T turns_before_feed = T(0.0);                        ///< rad turned between the start angle and the feed's begin
  T servo_lag = T(0.0);                                ///< time constant of the feed axis, s
  T latches_command = T(0.0);                          ///< 1: the control latches commanded positions, 0: actual ones
  T sampling_period = T(0.0), sampling_phase = T(0.0); ///< s; share of a period from the feed's begin
  T confirmations = T(0.0);                            ///< further revolutions until a trigger is accepted
  // insert
  T runout_x = T(0.0), runout_y = T(0.0); ///< of the tool's axis at the tool's centre, X through the first seat, m
  T tilt_x = T(0.0), tilt_y = T(0.0);     ///< of the tool about its centre: first about X, then about Y, rad
  std::array<InsertDeviation<T>, most_inserts> insert{};
};

} // namespace gumshoe::chain
