#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct BeamOffset {
  static constexpr QuantityCard quantities[] = {
      {.name = "x", .unit = "mm", .si_unit = "m", .limits = {-0.05, 0.05},
       .meaning = "offset along the nominal beam, machine X", .role = Role::pair, .typical = {1e-5, 1e-3}},
      {.name = "y", .unit = "mm", .si_unit = "m", .limits = {-0.05, 0.05},
       .meaning = "offset across the nominal beam, machine Y", .role = Role::pair, .typical = {1e-5, 1e-3}},
  };
  static constexpr EffectCard card{
      .name = "beam_offset",
      .title = "Offset of the spindle axis from the laser reference point",
      .stage = Stage::pose,
      .meaning = "The spindle axis does not pass through the laser reference point: x along, y across the nominal beam "
                 "(machine X and Y). The measurand is then the height of the reference point.",
      .adds = "tool_x += x; tool_y += y",
      .confused_with = "beam_pitch (a pitch of 0.2836 deg gives 4.95 um per mm along the beam)",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.tool_x = event.tool_x + q[0];
    event.tool_y = event.tool_y + q[1];
  }
};

} // namespace gumshoe::effects
