#pragma once
/// [conditions] and [indications]: the readings, one per group of equal labels and conditions, and their noise.
#include "scenario/readouts.h"

namespace gumshoe::scenario {

struct Readings {
  std::vector<IndicationReadouts> readouts; ///< by indication
  std::vector<quantities::Reading> readings;
  std::vector<Spread> spreads;
  std::vector<quantities::InputQuantity> noise; ///< by indication
};

/// Shape of [indications.NAME].
Shape indication_shape();

/// Reads both sections of the scenario `top`. The context learns the labels of the readings.
Readings read_readings(Table& top, const ModelCard& model, Method method, Context& context);

} // namespace gumshoe::scenario
