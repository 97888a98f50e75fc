#pragma once
/// The verdict of a trace for programs: the public interface of `gumshoe trace --json` (cli/README.md).
#include <string>

#include "tracing/trace.h"

namespace gumshoe::tracing {

/// Kind of the first finding, else "lack_of_fit", "anomalous_block", "nothing_found" or "insufficient_data".
std::string verdict(const Trace& trace);

/// A size in its display unit, or in SI if the conversion fails, so that a finished search is never lost. A quantity of
/// the scenario is a point on its scale (20 degC); any other size is a difference.
struct ShownSize {
  std::string unit;
  double value = 0, u = 0, low95 = 0, high95 = 0;
};
ShownSize shown(const SizedQuantity& quantity);
ShownSize shown(const DetectionLimit& limit); ///< value only

/// One JSON object. Root mean squares are SI, sizes in their shown units; numbers that are not finite are null.
std::string verdict_json(const Trace& trace);

} // namespace gumshoe::tracing
