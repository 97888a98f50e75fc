#pragma once
/// Comparisons of dual numbers: of their values. For code that runs on any scalar and refuses what is impossible.
#include "math/dual.h"

namespace gumshoe {

template <class R, int N> bool operator<(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v < b.v; }
template <class R, int N> bool operator>(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v > b.v; }
template <class R, int N> bool operator<=(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v <= b.v; }
template <class R, int N> bool operator>=(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v >= b.v; }
template <class R, int N> bool operator==(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v == b.v; }

} // namespace gumshoe
