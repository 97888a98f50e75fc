#pragma once
/// Rows that the cards of laser-tool-setter models share: quantities of the beam, conditions, the indication.
#include <type_traits>

#include "models/cards.h"
#include "models/laser_beam.h"
#include "models/model.h"

namespace gumshoe::models::laser_setter {

inline constexpr QuantityCard beam_yaw =
    in_deg({.name = "beam_yaw", .symbol = "alpha", .meaning = "yaw of the beam: angle about Z from machine X"});
inline constexpr QuantityCard beam_pitch =
    in_deg({.name = "beam_pitch",
            .limits = below_90,
            .symbol = "beta",
            .meaning = "pitch of the beam out of the horizontal, positive if the beam rises"});
inline constexpr QuantityCard beam_radius = in_mm({.name = "beam_radius",
                                                   .default_value = 0.2 * si::mm,
                                                   .limits = positive,
                                                   .symbol = "R_l",
                                                   .meaning = "radius of the beam's cross-section at the receiver"});
inline constexpr QuantityCard trigger_fraction =
    pure({.name = "trigger_fraction",
          .default_value = 0.5,
          .limits = {0, 1, true, true},
          .symbol = "eta",
          .meaning = "fraction of the beam's cross-section that is covered when the trigger fires"});
inline constexpr VariableCard time = shown_in_s({.name = "time", .meaning = "time since the start of the work"});
inline constexpr VariableCard direction =
    shown_pure({.name = "direction", .default_value = -1, .meaning = "direction of approach along Z: -1 downwards"});
inline constexpr VariableCard indications[] = {
    shown_in_mm({.name = "spindle_z", .meaning = "spindle height latched at the trigger, Z'_s"})};

/// The beam of a model whose quantities have the names above.
template <class Quantities> auto beam(const Quantities& q) -> Beam<std::decay_t<decltype(q.beam_yaw)>> {
  return {q.beam_yaw, q.beam_pitch, q.beam_radius, q.trigger_fraction};
}

/// Fills in an event as the conditions `feed`, `time` and `direction` command it, then lets the freed effects act.
template <class T, class At> void act(const At& at, const T& tool_length, chain::ProbingEvent<T>& event) {
  event.z.feed = at.c.feed;
  event.time = at.c.time;
  event.z.direction = at.c.direction;
  event.holder_angle = at.q.holder_angle;
  event.tool_length = tool_length;
  at.freed.act(event);
}

/// What an event moves, as the first intermediate values. @param tool_y from the beam's reference point, m
inline std::vector<Intermediate> intermediates(const chain::ProbingEvent<double>& event, double tool_y) {
  return {{"offset of the tool axis from the beam's reference point, X", "mm", event.tool_x / si::mm},
          {"offset of the tool axis from the beam's reference point, Y", "mm", tool_y / si::mm},
          {"tool growth", "mm", event.tool_growth / si::mm},
          {"axis error", "mm", event.z.error / si::mm},
          {"axis scale", "um/m", event.z.scale * 1e6}};
}

} // namespace gumshoe::models::laser_setter
