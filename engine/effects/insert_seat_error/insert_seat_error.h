#pragma once
#include "effects/per_insert.h"

namespace gumshoe::effects {

/// Radial seat of each insert. An insert sits farther from the tool's axis than tool_radius.
struct InsertSeatError {
  static constexpr QuantityCard each{"",
                                     "um",
                                     "m",
                                     0.0,
                                     {-5e-2, 5e-2},
                                     "dr_k",
                                     "this insert sits farther from the tool's axis by this",
                                     Role::amplitude,
                                     "5-20 um"};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      "insert_seat_error",
      "Radial seat of each insert",
      "insert",
      20,
      "",
      "An insert sits farther from the tool's axis than tool_radius says (radial run-out of one insert). Its axial "
      "seat is its wear.",
      "tool_radius, exactly, where all are equal; tool_runout (one cosine over all inserts); insert_radius_error",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::tool_radius);
  }
};

} // namespace gumshoe::effects
