#pragma once
/// The sections that do not touch quantities: [run], [analysis] and [[correlations]].
#include "base/card.h"
#include "scenario/context.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

RunOptions read_run(Table table);
AnalysisOptions read_analysis(Table table, const ModelCard& model,
                              const std::vector<quantities::InputQuantity>& quantities, Context& context);
/// loss, width, iterations, posterior
EstimateOptions read_estimate(Table table);
/// Names must be among `quantities`, "quantity.component", or "quantity[label]" where
/// values are given per label.
std::vector<quantities::Correlation> read_correlations(const std::vector<Node>& items, Problems& problems,
                                                       const std::vector<quantities::InputQuantity>& quantities);

} // namespace gumshoe::scenario
