#pragma once
/// Series of numbers, listed or in a column of a data file.
#include "scenario/context.h"

namespace gumshoe::scenario {

/// A list of numbers with units, or a column of a data file: { file, column, unit, decimal, where }.
Shape series_shape();
/// Reads it from the key; nullopt and problems if something is wrong or it is absent.
std::optional<std::vector<double>> read_series(Table& table, const std::string& key, const Dimension& dimension,
                                               Context& context);

} // namespace gumshoe::scenario
