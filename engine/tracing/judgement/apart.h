#pragma once
/// Keeps an anonymous shape apart from what has a name.
#include "tracing/fit/joint_fit.h"

namespace gumshoe::tracing {

/// The shape, if it does not depend on a label, without what unknowns and terms of the fit could do that depend on the
/// same things: their sizes are then those without the shape. Columns that all unknowns and terms together explain are
/// left out. The columns that remain span, together with the fit's own, what they spanned before.
/// @param rows training rows, whose mean squares decide
Candidate apart(const Candidate& shape, const JointFit& fit, const Observations& observations,
                const std::vector<Index>& rows);

} // namespace gumshoe::tracing
