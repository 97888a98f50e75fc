#pragma once
/// Does a fit predict what it has not seen? Parts of its own readings left out in turn.
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

/// Sum of squares of every part of the fit's readings predicted from the others, whitened by what is declared and the
/// given structure of noise. Fits are compared under one structure.
double cross_validated(const Observations& observations, const std::vector<Index>& rows, const JointFit& fit,
                       const Structure& structure);

} // namespace gumshoe::tracing
