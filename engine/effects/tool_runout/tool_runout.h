#pragma once
#include "chain/turning_tool.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct ToolRunout {
  static constexpr QuantityCard quantities[] = {
      {.name = "x", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "displacement at the tool's centre towards the first seat", .role = Role::pair,
       .typical = {1e-6, 20e-6}},
      {.name = "y", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "displacement a quarter turn ahead, counter-clockwise", .role = Role::pair, .typical = {1e-6, 20e-6}},
      {.name = "tilt_x", .unit = "mrad", .si_unit = "rad", .limits = {-0.1, 0.1},
       .meaning = "rotation of the tool about its X through its centre", .role = Role::pair, .typical = {2e-5, 2e-4}},
      {.name = "tilt_y", .unit = "mrad", .si_unit = "rad", .limits = {-0.1, 0.1},
       .meaning = "subsequent rotation about the Y of the spindle", .role = Role::pair, .typical = {2e-5, 2e-4}},
  };
  static constexpr EffectCard card{
      .name = "tool_runout",
      .title = "Run-out of a turning tool",
      .stage = Stage::insert,
      .meaning = "The tool's axis is displaced from the spindle axis by (x, y) and tilted by (tilt_x, tilt_y), in a "
                 "frame "
                 "that turns with the tool: X through the first seat, origin in the unworn tool's centre. Every "
                 "insert changes its radius, tangential seat, height and angles, exactly.",
      .adds = "runout_x += x; runout_y += y; tilt_x, tilt_y likewise, in the frame that turns with the tool",
      .confused_with =
          "wear (tilt raises the inserts as one cosine over them), insert_seat_error, insert_pitch_error",
      .source = "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::TurningTool<T>& tool = *event.turning;
    tool.runout_x = tool.runout_x + q[0];
    tool.runout_y = tool.runout_y + q[1];
    tool.tilt_x = tool.tilt_x + q[2];
    tool.tilt_y = tool.tilt_y + q[3];
  }
};

} // namespace gumshoe::effects
