#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Spindle axis beside the laser reference point. The spindle axis passes beside the laser reference point: x along, y
/// across the nominal beam (machine X and Y). The measurand is then the height of the reference point.
struct BeamOffset {
  static constexpr QuantityCard quantities[] = {
      {"x", "mm", "m", 0.0, {-0.05, 0.05}, "", "along the nominal beam, machine X", Role::pair, "0.01-1 mm"},
      {"y", "mm", "m", 0.0, {-0.05, 0.05}, "", "across the nominal beam, machine Y", Role::pair, "0.01-1 mm"},
  };
  static constexpr EffectCard card{
      "beam_offset",
      "Spindle axis beside the laser reference point",
      "pose",
      20,
      "",
      "The spindle axis passes beside the laser reference point: x along, y across the nominal beam (machine X and Y). "
      "The measurand is then the height of the reference point.",
      "beam_pitch (a pitch of 0.2836 deg gives 4.95 um per mm along the beam)",
      "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_x = event.tool_x + q[0];
    event.tool_y = event.tool_y + q[1];
  }
};

} // namespace gumshoe::effects
