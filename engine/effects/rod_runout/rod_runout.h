#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct RodRunout {
  static constexpr QuantityCard quantities[] = {
      {.name = "x", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "displacement along X of the tool holder", .role = Role::pair, .typical = {1e-6, 10e-6}},
      {.name = "y", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "displacement along Y of the tool holder", .role = Role::pair, .typical = {1e-6, 10e-6}},
  };
  static constexpr EffectCard card{
      .name = "rod_runout",
      .title = "Radial run-out of the rod",
      .stage = Stage::standing,
      .meaning = "The axis of the rod is displaced from the spindle axis in the tool-holder frame, so that it turns "
                 "with the "
                 "holder angle.",
      .adds = "tool_x += x cos theta - y sin theta; tool_y += x sin theta + y cos theta (theta: holder angle)",
      .confused_with =
          "beam_offset while the holder angle is constant; a tilted bottom makes it look like a rod length error",
      .source = "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const T c = num::cos(event.holder_angle), s = num::sin(event.holder_angle);
    event.tool_x = event.tool_x + (c * q[0] - s * q[1]);
    event.tool_y = event.tool_y + (s * q[0] + c * q[1]);
  }
};

} // namespace gumshoe::effects
