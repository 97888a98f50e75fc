#pragma once
/// From trees to the three programs of a statement.
#include "formula/compile.h"
#include "formula/resolve.h"

namespace gumshoe::formula {

/// first, first + 1, ..., last - 1.
std::vector<std::size_t> indices(std::size_t first, std::size_t last);

/// Builds `evaluate`, `explain` and, if every indication has a formula, `simulate`. Problems: formulas of indications
/// that need themselves.
void assemble(Compiled& compiled, const Names& names, std::vector<Problem>& problems);

} // namespace gumshoe::formula
