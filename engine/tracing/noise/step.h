#pragma once
/// The step in which readings were recorded.
#include <span>

namespace gumshoe::tracing {

/// The largest number of which all differences between the values are multiples, within what doubles hold; 0 where they
/// are too fine for that. Readings in steps of q are not known better than to q / sqrt(12) (JCGM 100, F.2.2.1).
double recorded_step(std::span<const double> values);
/// The step of readouts whose means these values are. `together` is the least common multiple of their numbers. If the
/// step of the display is `stated` (0: it is not), it is that one, unless the values are finer.
double recorded_step(std::span<const double> values, long together, double stated);

} // namespace gumshoe::tracing
