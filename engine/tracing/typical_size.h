#pragma once
/// What a card tells of sizes: what is typical, and where a shape quantity is tried.
#include <vector>

#include "base/card.h"

namespace gumshoe::tracing {

/// Upper end of "1-10 um: ..." in SI; 0 if it tells no range. `low` its lower end.
double typical_size(const QuantityCard& card, double* low = nullptr);

/// Values a shape quantity is tried at, its default first, SI.
std::vector<double> grid_of(const QuantityCard& card);

} // namespace gumshoe::tracing
