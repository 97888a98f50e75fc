#pragma once
#include "effects/per_insert.h"

namespace gumshoe::effects {

/// Radial angle of each insert. The rake face has another radial angle than insert_radial_angle.
struct InsertRadialAngleError {
  static constexpr QuantityCard each{"",
                                     "deg",
                                     "rad",
                                     0.0,
                                     {-1.5, 1.5},
                                     "dtheta_rk",
                                     "this insert's radial angle is larger by this",
                                     Role::amplitude,
                                     "0.05-0.5 deg"};
#define GUMSHOE_ROW(k) named("angle_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{"insert_radial_angle_error",
                                   "Radial angle of each insert",
                                   "insert",
                                   40,
                                   "",
                                   "An insert's rake face has another radial angle than insert_radial_angle, turned "
                                   "about its virtual cutting point.",
                                   "insert_radial_angle, exactly, where all are equal",
                                   "engineering knowledge; Fang 2022, chapter 3 for the measurement",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::radial_angle);
  }
};

} // namespace gumshoe::effects
