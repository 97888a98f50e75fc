#pragma once
#include "chain/probing_event.h"
#include "effects/effect.h"

namespace gumshoe::effects {

struct Pretravel {
  static constexpr QuantityCard quantities[] = {
      {.name = "distance", .unit = "um", .si_unit = "m", .limits = {-1e-3, 1e-3},
       .meaning = "travel along the approach from contact to trigger", .role = Role::amplitude,
       .typical = {2e-6, 20e-6, {}, true}},
  };
  static constexpr EffectCard card{
      .name = "pretravel",
      .title = "Pretravel of the probe",
      .stage = Stage::contact,
      .meaning =
          "The tip travels this distance along the approach, in any direction, from contact to trigger.",
      .adds = "pretravel += distance",
      .confused_with = "sphere_radius + tip_radius and probe_z, exactly if every approach is from the top",
      .source = "Estler et al. 1996, Precision Engineering; size: engineering knowledge",
      .quantities = quantities};
  template <class T> static void apply(const T* q, chain::ProbingEvent<T>& event) {
    event.pretravel = event.pretravel + q[0];
  }
};

} // namespace gumshoe::effects
