#pragma once
/// The noise of an indication as an input quantity: resolution, repeatability and further components.
#include "base/card.h"
#include "scenario/readouts.h"

namespace gumshoe::scenario {

/// Keys of an indication that state its noise.
std::vector<Key> noise_keys();

/// Reads the keys resolution, repeatability, u and components of [indications.NAME].
///
/// Resolution is rectangular, half a step either way, one draw per mean. Repeatability has the scale
/// s/sqrt(n), one draw per mean, with s from the reading's own repeats, declared, or pooled over all
/// cells of the data (GUM 4.2.4). s of rounded indications already contains the rounding, so of both
/// only the larger is used, and a note says which. Where there are `several` readings, further components state their
/// scope: without one all readings would share one draw.
quantities::InputQuantity read_noise(Table& table, const VariableCard& card, const IndicationReadouts& readouts,
                                     bool several, Context& context);

} // namespace gumshoe::scenario
