#pragma once
/// Comparisons of dual numbers, which are those of their values, and the selection by one. For code that runs on any scalar
/// and refuses what is impossible.
#include "math/dual.h"

namespace gumshoe {

template <class R, int N> bool operator<(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v < b.v; }
template <class R, int N> bool operator>(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v > b.v; }
template <class R, int N> bool operator<=(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v <= b.v; }
template <class R, int N> bool operator>=(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v >= b.v; }
template <class R, int N> bool operator==(const Dual<R, N>& a, const Dual<R, N>& b) { return a.v == b.v; }

namespace num {
/// mask ? a : b, derivatives included.
template <class R, int N> Dual<R, N> select(bool mask, const Dual<R, N>& a, const Dual<R, N>& b) { return mask ? a : b; }
} // namespace num

} // namespace gumshoe
