#pragma once
/// [choose]: what `gumshoe choose` may turn, what it must reach, what else it shows.
#include "scenario/context.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// What [choose] may name.
struct ChooseScope {
  const ModelCard& model;     ///< with its own measurands
  const Scenario& scenario;   ///< all but [choose]
  const Catalogue& catalogue; ///< for the limits of effects' quantities
};

Shape choose_shape();

/// Problems, each at its place: an unknown variable, an empty list, a range that is none, a value outside a limit, an
/// evaluation or a measurand that there is not, a target of another dimension, no formula for the time.
Choose read_choose(Table table, const ChooseScope& scope, Context& context);

} // namespace gumshoe::scenario
