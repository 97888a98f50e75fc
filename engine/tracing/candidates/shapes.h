#pragma once
/// Shapes without a cause: possible dependences of residuals on conditions, labels and the order of measurement.
#include "tracing/candidates/candidates.h"

namespace gumshoe::tracing {

/// Polynomials, harmonics of angles, steps by label and by two labels, hysteresis by direction of motion, products of
/// two covariates; a condition in one part alone; and the omnibus families: any smooth dependence on one covariate or
/// on two, any value at each level of what was set again and again, of each part by itself, too, and in each cell of
/// two labels.
/// @param most_cells  levels, or combinations of levels, up to which "any value" is a candidate
std::vector<Candidate> shapes(const Observations& observations, std::size_t most_cells);

} // namespace gumshoe::tracing
