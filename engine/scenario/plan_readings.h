#pragma once
/// The further readings that [plan] allows: every combination of listed values, or the rows of a file.
#include "scenario/context.h"
#include "scenario/plan_options.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

struct AllowedScope {
  const ModelCard& model;
  const Scenario& scenario; ///< with its readings and recorded columns
  double cost = 1;          ///< of a reading that states none
};

Shape allowed_readings_shape();

/// Reads `readings` or `points` of [plan].
std::vector<AllowedReading> read_allowed_readings(Table& plan, const AllowedScope& scope, Context& context);

} // namespace gumshoe::scenario
