#pragma once
#include "effects/per_insert.h"

namespace gumshoe::effects {

/// Angular seat of each insert. The azimuth of a seat is larger than even spacing makes it.
struct InsertPitchError {
  static constexpr QuantityCard each{"",
                                     "deg",
                                     "rad",
                                     0.0,
                                     {-3.2, 3.2},
                                     "dpsi_k",
                                     "this insert's seat is ahead of its even spacing by this, counter-clockwise",
                                     Role::amplitude,
                                     "0.02-0.2 deg; degrees in differential-pitch cutters"};
#define GUMSHOE_ROW(k) named("azimuth_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{"insert_pitch_error",
                                   "Angular seat of each insert",
                                   "insert",
                                   30,
                                   "",
                                   "An insert's seat is not evenly spaced: its azimuth is larger by this. It also "
                                   "states the spacing of a cutter with differential pitch.",
                                   "holder_angle, exactly, where all are equal; the start of the feed",
                                   "engineering knowledge; Fang 2022, chapter 3 for the measurement",
                                   quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::azimuth);
  }
};

} // namespace gumshoe::effects
