#pragma once
/// Reads [trace]: blocks, order, re-done set-up steps, and the quantities recorded with the readings.
#include "base/card.h"
#include "scenario/option.h"
#include "scenario/readouts.h"
#include "scenario/trace_options.h"

namespace gumshoe::scenario {

struct TraceScope {
  const ModelCard& model;
  const std::vector<quantities::Reading>& readings;
  const std::vector<IndicationReadouts>& readouts; ///< by indication; those used of the first are the readings
};

Options<TraceOptions> trace_options();
Shape trace_shape();

TraceOptions read_trace(Table table, const TraceScope& scope, Context& context);

} // namespace gumshoe::scenario
