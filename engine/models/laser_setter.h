#pragma once
/// What the models of a laser tool setter share: units, the beam's rows of their cards, conditions, the indication.
#include "base/si.h"
#include "chain/probing_event.h"
#include "models/laser_beam.h"
#include "models/model.h"

namespace gumshoe::models::laser_setter {

using si::mm, si::deg, si::rpm, si::minute;
inline constexpr double huge = 1e3; ///< limit of what has none: m or rad

inline constexpr QuantityCard beam_yaw{
    "beam_yaw", "deg", "rad", 0, {-huge, huge}, "alpha", "of the beam about Z, from machine X"};
inline constexpr QuantityCard beam_pitch{"beam_pitch",
                                         "deg",
                                         "rad",
                                         0,
                                         {-90 * deg, 90 * deg, true, true},
                                         "beta",
                                         "of the beam out of the horizontal, positive upwards along the beam"};
inline constexpr QuantityCard beam_radius{
    "beam_radius", "mm", "m", 0.2 * mm, {0, huge, true}, "R_l", "radius of the beam's disc on the receiver"};
inline constexpr QuantityCard trigger_fraction{"trigger_fraction",
                                               "1",
                                               "1",
                                               0.5,
                                               {0, 1, true, true},
                                               "eta",
                                               "share of the disc that is covered when the trigger fires"};
inline constexpr VariableCard time{"time", "s", "s", 0, "since the start of the work"};
inline constexpr VariableCard direction{"direction", "1", "1", -1, "of approach along Z: -1 downwards"};
inline constexpr VariableCard indications[] = {
    {"spindle_z", "mm", "m", 0, "spindle height latched at the trigger, Z'_s"}};

/// The beam, from four quantities in a row: yaw, pitch, radius, trigger fraction.
template <class T> Beam<T> beam(const T* q) { return {q[0], q[1], q[2], q[3]}; }

} // namespace gumshoe::models::laser_setter
