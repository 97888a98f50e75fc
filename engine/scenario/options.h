#pragma once
/// The sections [run] and [estimate], which name no quantity.
#include "scenario/option.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

Options<RunOptions> run_options();
Options<Adaptive> adaptive_options();
Options<EstimateOptions> estimate_options();

RunOptions read_run(Table table);
EstimateOptions read_estimate(Table table);

} // namespace gumshoe::scenario
