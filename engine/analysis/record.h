#pragma once
/// What a result says of its scenario: measurement equations, machine, input quantities.
#include "analysis/results.h"
#include "scenario/scenario.h"

namespace gumshoe::analysis {

std::vector<Equation> equations_of(const ModelCard& card, const std::string& evaluation);

std::vector<AxisRecord> axis_records(const ModelCard& card);

/// One row per quantity and set of labels; its components combined.
std::vector<InputRecord> input_records(const scenario::Scenario& scenario);

} // namespace gumshoe::analysis
