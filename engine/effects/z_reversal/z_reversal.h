#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// Reversal error of Z. The axis lags half the backlash behind its command on either approach.
struct ZReversal {
  static constexpr QuantityCard quantities[] = {
      {"backlash", "um", "m", 0.0, {-1e-3, 1e-3}, "B", "reversal value", Role::amplitude, "1-10 um"},
  };
  static constexpr EffectCard card{"z_reversal",
                                   "Reversal error of Z",
                                   "motion",
                                   20,
                                   "",
                                   "The axis lags half the backlash behind its command on either approach.",
                                   "any constant while all approaches come from one side",
                                   "engineering knowledge; Fang 2022, section 2.5 for the kinematic chain; ISO 230-2",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.axis_error = event.axis_error - event.direction * (0.5 * q[0]);
  }
};

} // namespace gumshoe::effects
