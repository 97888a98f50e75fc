#pragma once
/// The effects' functions for one scalar, in catalogue order. Adding an effect: its folder, its
/// include here, and its line in catalogue.def.
#include <array>

#include "effects/effect.h"
#include "effects/axis_reversal/axis_reversal.h"
#include "effects/beam_offset/beam_offset.h"
#include "effects/brake_shift/brake_shift.h"
#include "effects/c_axial_motion/c_axial_motion.h"
#include "effects/c_radial_motion/c_radial_motion.h"
#include "effects/c_tilt_motion/c_tilt_motion.h"
#include "effects/encoder_eccentricity/encoder_eccentricity.h"
#include "effects/encoder_ovality/encoder_ovality.h"
#include "effects/feed_start_delay/feed_start_delay.h"
#include "effects/gravity_sag/gravity_sag.h"
#include "effects/insert_axial_angle_error/insert_axial_angle_error.h"
#include "effects/insert_pitch_error/insert_pitch_error.h"
#include "effects/insert_radial_angle_error/insert_radial_angle_error.h"
#include "effects/insert_radius_error/insert_radius_error.h"
#include "effects/insert_seat_error/insert_seat_error.h"
#include "effects/pretravel/pretravel.h"
#include "effects/pretravel_bending/pretravel_bending.h"
#include "effects/pretravel_lobing/pretravel_lobing.h"
#include "effects/reclamp/reclamp.h"
#include "effects/revolution_confirm/revolution_confirm.h"
#include "effects/rod_expansion/rod_expansion.h"
#include "effects/rod_runout/rod_runout.h"
#include "effects/sampling_rate/sampling_rate.h"
#include "effects/scale/scale.h"
#include "effects/servo_lag/servo_lag.h"
#include "effects/spindle_axial_shift/spindle_axial_shift.h"
#include "effects/spindle_speed_error/spindle_speed_error.h"
#include "effects/straightness/straightness.h"
#include "effects/thermal_drift/thermal_drift.h"
#include "effects/thermal_growth/thermal_growth.h"
#include "effects/tool_runout/tool_runout.h"
#include "effects/trigger_latency/trigger_latency.h"
#include "effects/z_reversal/z_reversal.h"

namespace gumshoe::effects {

template <class T> using Apply = void (*)(const T* quantities, chain::ProbingEvent<T>& event);

#define GUMSHOE_EFFECT(folder, type) +1
inline constexpr std::size_t count = 0
#include "effects/catalogue.def"
    ;
#undef GUMSHOE_EFFECT

template <class T> const std::array<Apply<T>, count>& functions() {
#define GUMSHOE_EFFECT(folder, type) &type::apply<T>,
  static const std::array<Apply<T>, count> table{
#include "effects/catalogue.def"
  };
#undef GUMSHOE_EFFECT
  return table;
}

/// Lets the active effects act on an event that is filled in as commanded.
template <class T> void act(std::span<const Active> active, const T* quantities, chain::ProbingEvent<T>& event) {
  for (const Active& a : active) functions<T>()[a.effect](quantities + a.first, event);
}

} // namespace gumshoe::effects
