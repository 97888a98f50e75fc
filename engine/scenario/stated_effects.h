#pragma once
/// Reads [stated_effects.NAME]: effects as formulas of conditions and columns, which add to an indication.
#include "base/card.h"
#include "scenario/context.h"
#include "scenario/trace_options.h"

namespace gumshoe::scenario {

struct StatedScope {
  const ModelCard& model;
  const std::vector<quantities::Reading>& readings;
  const std::vector<TraceColumn>& columns;
  const std::vector<std::string>& effects; ///< names of the catalogue
};

struct StatedEffects {
  std::vector<StatedEffect> effects;
  std::vector<quantities::InputQuantity> sizes; ///< "NAME.size" of the freed ones, in their order
};

Shape stated_effects_shape();

/// Problems stand at the formula's character: names other than conditions and columns, dimensions that do not fit.
StatedEffects read_stated_effects(Table& table, const StatedScope& scope, Context& context);

} // namespace gumshoe::scenario
