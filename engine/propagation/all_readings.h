#pragma once
/// All readings of a joint evaluation as one sample.
#include "propagation/forward_model.h"

namespace gumshoe::propagation {

/// The block refers to the points.
struct AllReadings {
  Points points;
  Block block;
};

/// Stated effects are subtracted.
AllReadings all_readings(const ForwardModel& forward, const Points& at);

} // namespace gumshoe::propagation
