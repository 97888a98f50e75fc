#pragma once
/// [[expected]]: published or exact figures that `gumshoe gauge` compares with ours.
#include "scenario/context.h"
#include "scenario/scenario.h"

namespace gumshoe::scenario {

/// Shape of a row.
Shape expected_shape();

/// { figure = "standard_uncertainty", of = "y", value = "0.0755 mg", source = "JCGM 101, Table 5" }
std::vector<Expected> read_expected(Table& top, const ModelCard& model, Context& context);

} // namespace gumshoe::scenario
