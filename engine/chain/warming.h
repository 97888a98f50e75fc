#pragma once
/// How a part that is warmed at a constant power lengthens with time (ISO 230-3; heat balance of one body).
#include "math/scalar.h"

namespace gumshoe::chain {

/// 1 - exp(-time / time_constant): share of the final value. Units: s.
template <class T> T first_order_rise(const T& time, const T& time_constant) {
  return 1.0 - num::exp(-(time / time_constant));
}

/// Steady growth and a first-order rise: rate time + amplitude (1 - exp(-time / time_constant)). Units: m/s, m, s.
template <class T> T warming(const T& rate, const T& amplitude, const T& time_constant, const T& time) {
  return rate * time + amplitude * first_order_rise(time, time_constant);
}

} // namespace gumshoe::chain
