#pragma once
#include <string>

#include "tracing/trace.h"

namespace gumshoe::tracing {

/// "a wave of period 20.1 mm and amplitude 0.79 um explains 96 % of it" where that is most of a table by one condition;
/// else empty. Of few levels chance alone would show some wave.
std::string wave_of(const Curve& table, const std::string& unit);

} // namespace gumshoe::tracing
