#pragma once
#include "chain/scanning.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct StampSkew {
  static constexpr QuantityCard quantities[] = {
      {.name = "delay", .unit = "ms", .si_unit = "s", .limits = {-1, 1}, .meaning = "from the axes' time stamp to the sensor's",
       .role = Role::amplitude, .typical = {0.1e-3, 5e-3}},
  };
  static constexpr EffectCard card{
      .name = "stamp_skew",
      .title = "Skew between the time stamps of sensor and axes",
      .stage = Stage::scanning,
      .meaning = "The sensor is read later than the axes whose positions are logged with it: what it shows belongs to a point "
                 "that is ahead by speed times delay in the direction of the scan.",
      .adds = "skew += delay",
      .confused_with = "c_axis_reversal; a zero position of C; anything at all if every scan has one speed and direction",
      .source = "engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.scanning->skew = event.scanning->skew + q[0];
  }
};

} // namespace gumshoe::effects
