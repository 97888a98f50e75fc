#pragma once
/// Branch-free choices between values, for double and for lanes alike.
#include <cmath>
#include <type_traits>

#include "math/scalar.h"

namespace gumshoe::models::tool_length {

/// bool, or a mask of lanes.
template <class V> using Mask = decltype(std::declval<V>() < std::declval<V>());

/// As std::min and std::max, also where a number is NaN.
template <class V> V smaller(const V& a, const V& b) { return num::select(b < a, b, a); }
template <class V> V larger(const V& a, const V& b) { return num::select(a < b, b, a); }

inline double rounded_up(double x) { return std::ceil(x); }
inline Lanes rounded_up(const Lanes& x) { return xsimd::ceil(x); }

inline SineCosine<double> sine_cosine(double x) {
  const auto sc = sine_cosine_lane(Lanes(x));
  return {sc.sine.get(0), sc.cosine.get(0)};
}
inline SineCosine<Lanes> sine_cosine(const Lanes& x) { return sine_cosine_lane(x); }

/// asin x for |x| <= 1; NaN beyond.
template <class V> V arc_sine(const V& x) { return num::atan2(x, num::sqrt((1.0 - x) * (1.0 + x))); }

/// The mask that holds everywhere, or nowhere.
template <class V> Mask<V> everywhere(bool holds) { return V(holds ? 0.0 : 1.0) < V(0.5); }

} // namespace gumshoe::models::tool_length
