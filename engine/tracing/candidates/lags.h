#pragma once
/// A condition that the readings follow with a delay: the workpiece is not yet as warm as the air, the spindle's
/// housing not yet as its speed would have it.
#include <utility>

#include "tracing/candidates/forms.h"

namespace gumshoe::tracing {

/// For each indication and each condition or column that was recorded, and no position: that which follows it with a
/// lag of first order, tau ds/dt + s = c, with the time constant that explains most. The condition is taken to be
/// linear between readings, and to have been met for long at the first one. Its p-value counts criteria.lag_forms
/// times.
std::vector<Candidate> lags(const Observations& observations, const Gain& gain);

/// The lag whose time constant over the range of time has this logarithm.
Candidate lag(const Observations& observations, const Covariate& condition, const Covariate& time,
              std::size_t indication, double logarithm);

/// Logarithms of the shortest and the longest time constant over the range: half of a usual step from one reading to
/// the next, and half of the range.
std::pair<double, double> limits_of_lag(const Covariate& time);

} // namespace gumshoe::tracing
