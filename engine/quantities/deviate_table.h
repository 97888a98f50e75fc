#pragma once
/// Tabulated quantile functions of Students' t and gamma, which have no closed form.
#include <memory>
#include <vector>

#include "quantities/quantile_kernels.h"

namespace gumshoe::quantities {

/// Piecewise polynomials over the octaves of p = min(u, 1 - u); relative error of the deviate below
/// 1e-12 for u between 2^-53 and 1 - 2^-53.
struct DeviateTable {
  std::vector<double> lower, upper;
  int log2_pieces = 0;
  TableView view() const { return {lower.data(), upper.data(), log2_pieces}; }
};

/// Standard t: T / (u - 1/2), which is even in u - 1/2; one table serves both halves.
std::shared_ptr<const DeviateTable> t_table(double degrees_of_freedom);
/// Standard gamma (scale 1).
std::shared_ptr<const DeviateTable> gamma_table(double shape);

} // namespace gumshoe::quantities
