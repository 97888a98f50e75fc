#pragma once
#include "effects/per_insert.h"

namespace gumshoe::effects {

/// Radius of each insert. The cutting edge has another radius than insert_radius; the virtual cutting point stays.
struct InsertRadiusError {
  static constexpr QuantityCard each{"",
                                     "um",
                                     "m",
                                     0.0,
                                     {-5e-2, 5e-2},
                                     "dR_k",
                                     "this insert's cutting edge has a radius larger by this",
                                     Role::amplitude,
                                     "12-75 um (ISO 1832, classes G and M)"};
#define GUMSHOE_ROW(k) named("radius_" #k, each)
  static constexpr QuantityCard quantities[] = {GUMSHOE_FOR_EACH_INSERT(GUMSHOE_ROW)};
#undef GUMSHOE_ROW
  static constexpr EffectCard card{
      "insert_radius_error",
      "Radius of each insert",
      "insert",
      10,
      "",
      "An insert's cutting edge has another radius than insert_radius. Its virtual cutting point stays: the edge still "
      "touches tool_radius outside and the tool's end below, as with insert_radius itself. An insert that stands out "
      "of its pocket has insert_seat_error and a negative wear besides.",
      "insert_radius, exactly, where all are equal; hardly seen in the height while the lowest point triggers",
      "engineering knowledge; Fang 2022, chapter 3 for the measurement",
      quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    add_to_inserts(q, event, &chain::InsertDeviation<T>::radius);
  }
};

} // namespace gumshoe::effects
