#pragma once
#include "chain/contouring.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A row of the card.
struct MismatchedGain {
  static constexpr QuantityCard row(std::string_view name, std::string_view symbol, std::string_view meaning) {
    return {.name = name, .unit = "%", .si_unit = "1", .limits = {-0.9, 9}, .symbol = symbol, .meaning = meaning,
            .role = Role::amplitude, .typical = {0.01, 0.1, "45 um at 1778 mm/min on a line at 45 deg for 10 % of 30 1/s"}};
  }
};

struct ServoGainMismatch {
  static constexpr QuantityCard quantities[] = {MismatchedGain::row("y", "K_y/K_x - 1", "loop gain of Y above that of X, as a share"),
                                                MismatchedGain::row("z", "K_z/K_x - 1", "loop gain of Z above that of X, as a share")};
  static constexpr EffectCard card{
      .name = "servo_gain_mismatch",
      .title = "Loop gains that differ between the slides",
      .stage = Stage::contouring,
      .meaning = "Slides with unequal loop gains lag their commands by unequal times. At constant feed v a line at the "
                 "angle a is offset by v sin a cos a (1/K_x - 1/K_y), and a circle becomes an ellipse at 45 deg whose "
                 "deviation has the range v abs(1/K_x - 1/K_y). Both grow with the feed. The gain of X is loop_gain.",
      .adds = "y.gain_error += y; z.gain_error += z",
      .confused_with = "squareness on lines and circles of one feed and one sense; origin on one line",
      .source = "Schmitz and Ziegert 1999, sections 3.1 and 3.6",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    chain::Contouring<T>& c = *event.contouring;
    c.y.gain_error = c.y.gain_error + q[0];
    c.z.gain_error = c.z.gain_error + q[1];
  }
};

} // namespace gumshoe::effects
