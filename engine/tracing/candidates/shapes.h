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

/// Smooth basis of one covariate by reading of the sequence, constant left out: indicator of each level if there are at
/// most `most` + 1, harmonics of an angle that goes round, else a cubic spline with `most` columns.
Matrix smooth_basis(const Observations& observations, const Covariate& covariate, int most);

} // namespace gumshoe::tracing
