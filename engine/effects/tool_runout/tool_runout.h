#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Run-out of a turning tool: its axis lies beside the spindle axis and is tilted, in the tool's frame, which turns.
struct ToolRunout {
  static constexpr QuantityCard quantities[] = {
      {"x",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "displacement at the tool's centre towards the first seat",
       Role::pair,
       "1-20 um"},
      {"y",
       "um",
       "m",
       0.0,
       {-1e-3, 1e-3},
       "",
       "displacement a quarter turn ahead, counter-clockwise",
       Role::pair,
       "1-20 um"},
      {"tilt_x",
       "mrad",
       "rad",
       0.0,
       {-0.1, 0.1},
       "",
       "turn of the tool about its X, through its centre",
       Role::pair,
       "0.02-0.2 mrad"},
      {"tilt_y", "mrad", "rad", 0.0, {-0.1, 0.1}, "", "then about the Y of the spindle", Role::pair, "0.02-0.2 mrad"},
  };
  static constexpr EffectCard card{
      "tool_runout",
      "Run-out of a turning tool",
      "insert",
      60,
      "",
      "The tool's axis lies beside the spindle axis by (x, y) and is tilted by (tilt_x, tilt_y), in a frame that turns "
      "with the tool: X through the first seat, origin in the unworn tool's centre. Every insert changes its radius, "
      "tangential seat, height and angles, exactly.",
      "wear (tilt raises the inserts as one cosine over them), insert_seat_error, insert_pitch_error",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.runout_x = tool.runout_x + q[0];
    tool.runout_y = tool.runout_y + q[1];
    tool.tilt_x = tool.tilt_x + q[2];
    tool.tilt_y = tool.tilt_y + q[3];
  }
};

} // namespace gumshoe::effects
