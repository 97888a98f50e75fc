#pragma once
/// An axis that follows its command with a first-order lag, from rest: commanded x, actual x - behind(x, lag). The same
/// in time, in path (feed times time constant) and in spindle angle (speed times time constant).
#include "math/scalar.h"

namespace gumshoe::models::tool_length {

/// lag (1 - exp(-x / lag)), lag >= 0; 0 without lag. Beyond 700 lags the exponential is below 1e-304.
template <class T> T behind(const T& x, const T& lag) {
  if (num::value(lag) == 0 || num::value(x) >= 700 * num::value(lag)) return lag;
  return lag * (1.0 - num::exp(-(x / lag)));
}

/// Its slope: exp(-x / lag).
inline double falling_behind(double x, double lag) { return lag == 0 || x >= 700 * lag ? 0.0 : num::exp(-(x / lag)); }

} // namespace gumshoe::models::tool_length
