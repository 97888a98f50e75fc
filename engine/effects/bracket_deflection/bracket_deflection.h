#pragma once
#include "chain/ball_bar.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct BracketDeflection {
  static constexpr QuantityCard quantities[] = {
      {.name = "deflection", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "by which a horizontal bar moves the sockets apart", .role = Role::amplitude,
       .typical = {0.5e-6, 5e-6}},
  };
  static constexpr EffectCard card{
      .name = "bracket_deflection",
      .title = "Deflection of the brackets that hold a ball bar",
      .stage = Stage::bar,
      .meaning = "The bar's spring pushes its sockets apart. Their brackets yield sideways and are stiff upright: the "
                 "bar indicates too much, in proportion to the square of the sine of its angle to Z.",
      .adds = "bar.zero += deflection (1 - along_z^2)",
      .confused_with = "bar_zero, exactly, if all directions are inclined alike",
      .source = "engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    const T up = event.bar->along.z;
    event.bar->zero = event.bar->zero + q[0] * (1.0 - up * up);
  }
};

} // namespace gumshoe::effects
