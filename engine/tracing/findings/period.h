#pragma once
#include <string>

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

} // namespace gumshoe::tracing
