#pragma once
/// Reads [plan]: the further readings that are allowed, what they cost, and what they must reach.
#include "scenario/plan_options.h"
#include "scenario/readouts.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// Names that [plan] may use.
struct PlanScope {
  const ModelCard& model;
  const Scenario& scenario; ///< all but [plan]
  const Catalogue& catalogue;
  const std::vector<IndicationReadouts>& readouts; ///< by indication
  const Node* indications = nullptr;               ///< [indications]
};

Shape plan_shape();

/// Problems, each at its place: an unknown effect, quantity, label or condition, a value of another dimension, a label
/// or condition that varies and is not listed, too many readings, goals without a limit.
Plan read_plan(Table table, const PlanScope& scope, Context& context);

} // namespace gumshoe::scenario
