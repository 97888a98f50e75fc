#pragma once
/// The step in which readings were recorded.
#include <span>

namespace gumshoe::tracing {

/// The largest number of which all differences between the values are multiples, within what doubles hold; 0 where they
/// are too fine for that. Readings in steps of q are not known better than to q / sqrt(12) (JCGM 100, F.2.2.1).
double recorded_step(std::span<const double> values);
/// Of means of readouts, whose numbers have the least common multiple `together`: the step of the readouts. Where the
/// step of the display is `stated` (0: it is not), that one, unless the values are finer.
double recorded_step(std::span<const double> values, long together, double stated);

} // namespace gumshoe::tracing
