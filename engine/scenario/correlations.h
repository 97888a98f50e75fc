#pragma once
/// [[correlations]]: dependence between input quantities.
#include "quantities/input_quantity.h"
#include "scenario/context.h"
#include "scenario/reader.h"

namespace gumshoe::scenario {

/// Shape of a row of [[correlations]].
Shape correlation_shape();

/// Reads the section of the scenario `top`. Names must be among `quantities`, "quantity.component", or
/// "quantity[label]" where values are given per label; those of labels that no reading has are left out. Quantities with
/// simultaneous observations are given their joint distribution.
std::vector<quantities::Correlation> read_correlations(Table& top, std::vector<quantities::InputQuantity>& quantities,
                                                       Context& context);

} // namespace gumshoe::scenario
