#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

/// A row of the card.
struct SquarenessError {
  static constexpr QuantityCard row(std::string_view name, std::string_view meaning) {
    return {.name = name, .unit = "um/m", .si_unit = "rad", .limits = {-0.1, 0.1}, .symbol = name, .meaning = meaning,
            .role = Role::amplitude, .typical = {5e-6, 50e-6}};
  }
};

struct Squareness {
  static constexpr QuantityCard quantities[] = {SquarenessError::row("E_B0X", "of X to Z: X drops by this per length"),
                                                SquarenessError::row("E_C0Y", "of Y to X: Y leans towards -X by this per length"),
                                                SquarenessError::row("E_A0Y", "of Y to Z: Y rises by this per length")};
  static constexpr EffectCard card{
      .name = "squareness",
      .title = "Squareness of X and Y in the machine's frame",
      .stage = Stage::contouring,
      .iso230 = "E_B0X, E_C0Y, E_A0Y",
      .meaning = "X and Y are not square to each other and to Z. The frame has its Z along the motion of Z and its X in "
                 "the plane of the motions of Z and X, so that these three errors are all there are.",
      .adds = "x.error -= E_C0Y y; z.error += E_A0Y y - E_B0X x",
      .confused_with = "servo_gain_mismatch on circles and lines of one feed and one sense; directions of the motions "
                       "that define the frame",
      .source = "ISO 230-1; Schmitz and Ziegert 1999, appendix A for the frame",
      .quantities = quantities,
      .follows_derivative = true};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.x.error = event.x.error - q[1] * event.y.position;
    event.z.error = event.z.error + (q[2] * event.y.position - q[0] * event.x.position);
  }
};

} // namespace gumshoe::effects
