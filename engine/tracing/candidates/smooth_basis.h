#pragma once
/// A covariate as columns, by reading of the sequence.
#include "tracing/matrix.h"
#include "tracing/noise/observations.h"

namespace gumshoe::tracing {

/// Its values, SI.
Vector plain(const Observations& observations, const Covariate& covariate);
/// The same from -1 at its lowest level to 1 at its highest.
Vector scaled(const Observations& observations, const Covariate& covariate);

/// The same from 0 to 1.
Vector over_the_range(const Observations& observations, const Covariate& covariate);

/// Smooth basis of one covariate by reading of the sequence, constant left out: indicator of each level if there are at
/// most `most` + 1, harmonics of an angle that goes round, else a cubic spline with `most` columns.
Matrix smooth_basis(const Observations& observations, const Covariate& covariate, int most);

} // namespace gumshoe::tracing
