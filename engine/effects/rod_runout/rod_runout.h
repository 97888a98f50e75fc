#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Radial run-out of the rod. The axis of the rod lies beside the spindle axis, in the tool-holder frame, so it turns
/// with the holder angle.
struct RodRunout {
  static constexpr QuantityCard quantities[] = {
      {"x", "um", "m", 0.0, {-1e-3, 1e-3}, "", "displacement along X of the tool holder", Role::pair, "1-10 um"},
      {"y", "um", "m", 0.0, {-1e-3, 1e-3}, "", "displacement along Y of the tool holder", Role::pair, "1-10 um"},
  };
  static constexpr EffectCard card{
      "rod_runout",
      "Radial run-out of the rod",
      "standing",
      10,
      "",
      "The axis of the rod lies beside the spindle axis, in the tool-holder frame, so it turns with the holder angle.",
      "beam_offset while the holder angle is constant; a tilted bottom makes it look like a rod length error",
      "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const T c = num::cos(event.holder_angle), s = num::sin(event.holder_angle);
    event.tool_x = event.tool_x + (c * q[0] - s * q[1]);
    event.tool_y = event.tool_y + (s * q[0] + c * q[1]);
  }
};

} // namespace gumshoe::effects
