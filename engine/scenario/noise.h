#pragma once
/// The noise of an indication as an input quantity: resolution, repeatability and further components.
#include "base/card.h"
#include "scenario/readouts.h"

namespace gumshoe::scenario {

/// Reads the keys resolution, repeatability and components of [indications.NAME].
///
/// Resolution is rectangular, half a step either way, one draw per mean. Repeatability has the scale
/// s/sqrt(n), one draw per mean, with s from the reading's own repeats, declared, or pooled over all
/// cells of the data (GUM 4.2.4). s of rounded readouts already contains the rounding, so of both
/// only the larger is used, and a note says which.
quantities::InputQuantity read_noise(Table& table, const VariableCard& card, const IndicationReadouts& readouts,
                                     Context& context);

struct Scatter {
  double s = 0;
  double degrees_of_freedom = 0;
};
/// Pooled experimental standard deviation: s^2 = sum of squares / sum of (n_i - 1), GUM 4.2.4.
Scatter pooled_scatter(const std::vector<Readouts>& cells);

} // namespace gumshoe::scenario
