#pragma once
#include <string>
#include <vector>

#include "tracing/matrix.h"
#include "tracing/noise/observations.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {

/// "a wave of period 20.1 mm and amplitude 0.79 um explains 96 % of it" where that is most of a table by one condition;
/// else empty. Of few levels chance alone would show some wave.
/// @param unit  of the amplitude
std::string wave_of(const CellTable& table, const std::string& unit);

/// "; read in steps of 13.7 mm, waves of period 21.7 mm and 10.0 mm look the same": the longest two shorter ones (the
/// sampling theorem). Empty where the levels are in no equal steps, which tells waves apart.
/// @param period SI
std::string aliases(const Covariate& covariate, double period);

/// Periods of other waves, SI, with which these readings would show nearly the same, the longest first and four at
/// most: where readings lie in stretches with gaps between, such as hours of several days, the waves that go round once
/// more or less in a gap. Empty where the readings have no such gaps.
/// @param along of the readings, SI  @param wave  what it adds to them
std::vector<double> alike(const Vector& along, const Vector& wave, double period);

/// Unit in which a duration of seconds has two of at least: "h" of 8 h; other units as they are.
std::string unit_of_duration(const Covariate& covariate, double duration);

/// "8.02 h" of seconds; other units as they are.
std::string shown_period(const Covariate& covariate, double period);

} // namespace gumshoe::tracing
